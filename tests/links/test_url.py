import subprocess
import sys

import pytest
from can.interfaces import VALID_INTERFACES
from hypothesis import given
from hypothesis import strategies as st

from teleop.links.url import CAN_INTERFACES, LinkAddress, LinkUrlError, parse


@pytest.mark.parametrize(
    ("url", "address"),
    [
        ("socketcan:can0", LinkAddress("can", "socketcan", "can0", 1_000_000)),
        ("socketcan:can0@500000", LinkAddress("can", "socketcan", "can0", 500_000)),
        ("slcan:/dev/ttyACM0", LinkAddress("can", "slcan", "/dev/ttyACM0", 1_000_000)),
        ("slcan:/dev/ttyACM0@115200@1000000", LinkAddress("can", "slcan", "/dev/ttyACM0@115200", 1_000_000)),
        ("gs_usb:0", LinkAddress("can", "gs_usb", "0", 1_000_000)),
        ("udp_multicast:239.74.163.2", LinkAddress("can", "udp_multicast", "239.74.163.2", 1_000_000)),
        ("udp_multicast:ff15::1:2", LinkAddress("can", "udp_multicast", "ff15::1:2", 1_000_000)),
        ("virtual:demo", LinkAddress("can", "virtual", "demo", 1_000_000)),
        (
            "serial:/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0@230400",
            LinkAddress("serial", "serial", "/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0", 230_400),
        ),
        ("sim:", LinkAddress("sim", "sim")),
    ],
)
def test_the_urls_of_the_documentation(url: str, address: LinkAddress) -> None:
    assert parse(url) == address


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("can0", "has no interface"),
        ("/dev/ttyACM0", "has no interface"),
        ("socketcan:", "has no channel"),
        ("socketcan:@500000", "has no channel"),
        ("sim:gimbal", "write sim:"),
        ("serial:/dev/ttyUSB0", "has no baud rate: write it as in serial:/dev/ttyUSB0@230400"),
        ("socketcan:can0@fast", "whole number of bit/s, not 'fast'"),
        ("socketcan:can0@0", "whole number of bit/s, not '0'"),
        ("socketcan:can0@", "whole number of bit/s, not ''"),
        ("socketcan:can0@-1", "whole number of bit/s"),
        ("socketcan:can0@\u00b2", "whole number of bit/s"),
        ("soketcan:can0", "did you mean socketcan"),
        ("slcam:/dev/ttyACM0", "did you mean slcan"),
        ("http://host", "there are canalystii, "),
    ],
)
def test_what_is_no_link_says_what_would_be(url: str, says: str) -> None:
    with pytest.raises(LinkUrlError) as refused:
        parse(url)
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@given(st.text())
def test_any_text_is_an_address_or_a_url_error(text: str) -> None:
    try:
        address = parse(text)
    except LinkUrlError:
        return
    assert parse(str(address)) == address


@given(
    st.sampled_from(sorted(CAN_INTERFACES)),
    st.text(min_size=1).filter(lambda channel: "@" not in channel),
    st.integers(1, 8_000_000),
)
def test_an_address_gives_its_url_back(interface: str, channel: str, bitrate: int) -> None:
    address = LinkAddress("can", interface, channel, bitrate)
    assert parse(str(address)) == address


def test_the_known_interfaces_are_those_of_python_can() -> None:
    assert CAN_INTERFACES | {"serial"} == VALID_INTERFACES


def test_parsing_does_not_pay_for_python_can() -> None:
    program = "import sys; from teleop.links import parse; parse('gs_usb:0'); sys.exit('can' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
