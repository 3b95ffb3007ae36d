"""The examples below each command's help; a test reads each of them as it would be typed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

EXAMPLES: Mapping[str, Sequence[str]] = {
    "": ["teleop play reveal", "teleop live", "teleop list"],
    "play": [
        "teleop play reveal",
        "teleop play ./mine.yaml --rig rs2 --link gimbal=socketcan:can0",
        "teleop play reveal --start-at key3 --speed 50%",
        "teleop play reveal --passes 3 --learn --take reveal.mcap",
        "teleop play reveal --learned reveal.learned.json",
        "teleop play day-to-night --rehearse",
    ],
    "live": [
        "teleop live",
        "teleop live --rig rs2 --link gimbal=slcan:/dev/ttyACM0",
        "teleop live --sticks recorded.csv --fast",
    ],
    "console": [
        "teleop console",
        "teleop console --rig rs2 --bind 0.0.0.0:8470 --moves shots/",
        "teleop console --bind 127.0.0.1:0 --json",
    ],
    "fleet": [
        "teleop fleet",
        "teleop fleet --json --once --connect tcp/127.0.0.1:7447",
        "teleop fleet --connect tls/192.168.1.20:7447 --credentials keys/operator.yaml",
    ],
    "fleet stop": ["teleop fleet stop", "teleop fleet stop cam-a cam-b", "teleop fleet stop --all"],
    "fleet play": [
        "teleop fleet play cam-a=wide.yaml cam-b=close.yaml --at now+5s",
        "teleop fleet play cam-a=wide.yaml --at 18:30:00 --attended",
    ],
    "fleet sticks": ["teleop fleet sticks cam-a"],
    "fleet keys": [
        "teleop fleet keys keys/ --rig cam-a --rig cam-b --operator anna",
        "teleop fleet keys keys/ --watcher monitor --router studio",
    ],
    "check": ["teleop check reveal", "teleop check ./mine.yaml --rig rs2"],
    "preview": [
        "teleop preview reveal -o move.html",
        "teleop preview reveal --csv move.csv --rate 25",
        "teleop preview ./mine.yaml -o mine.html --watch",
    ],
    "list": ["teleop list", "teleop list moves", "teleop list rigs --json"],
    "copy": ["teleop copy reveal mine.yaml", "teleop copy rs2 my-rig.yaml"],
    "export": [
        "teleop export reveal -o reveal.chan --rate 24000/1001",
        "teleop export run.mcap -o run.csv",
        "teleop export reveal -o reveal.py --first-frame 1001",
    ],
    "import": [
        "teleop import shot.chan -o shot.yaml --rate 24 --rotation-order ZXY",
        "teleop import move.txt -o move.yaml --format raw --rate 25 --columns pan,tilt",
        "teleop import camera.usdc -o camera.yaml --rig rs3-pro",
    ],
    "take": ["teleop take list", "teleop take report run.mcap -o run.html"],
    "take list": ["teleop take list", "teleop take list shots/"],
    "take info": ["teleop take info run.mcap"],
    "take export": ["teleop take export run.mcap --csv run.csv"],
    "take keyframes": ["teleop take keyframes run.mcap -o mine.yaml --tolerance 0.2"],
    "take report": ["teleop take report run.mcap", "teleop take report run.mcap -o run.html"],
    "take certificate": [
        "teleop take certificate run.mcap -o run.html",
        "teleop take certificate pass1.mcap pass2.mcap -o shot.html --fps 25",
    ],
    "take recover": ["teleop take recover run.mcap"],
    "commission": [
        "teleop commission",
        "teleop commission -o rehearsal.yaml",
        "teleop commission --rig rs5 --link gimbal=socketcan:can0",
    ],
    "calibrate": [
        "teleop calibrate --dry-run --rig rs2",
        "teleop calibrate --rig rs2 --link gimbal=socketcan:can0 -o response.html",
    ],
    "calibrate response": ["teleop calibrate response --axis pan --rig rs2"],
    "calibrate delay": ["teleop calibrate delay --axis tilt --rig rs2"],
    "calibrate signs": ["teleop calibrate signs --rig rs5 --link gimbal=socketcan:can0"],
    "devices": ["teleop devices", "teleop devices --json"],
    "devices record": [
        "teleop devices record -o pad.jsonl",
        "teleop devices record 046d:c216 -o pad.jsonl --seconds 20",
    ],
    "doctor": ["teleop doctor"],
    "forget": ["teleop forget", "teleop forget --rig rs2"],
    "send": [
        "teleop send recenter",
        "teleop send gimbal position yaw=10 --rig rs2 --link gimbal=socketcan:can0",
        "teleop send camera record --rig rs2",
    ],
    "monitor": [
        "teleop monitor --rig rs2 --link gimbal=socketcan:can0",
        "teleop monitor --rig rs2 --link gimbal=socketcan:can0 -o bus.log",
        "teleop monitor drone --rig m100 --link drone=serial:/dev/ttyUSB0@230400",
    ],
    "sim": [
        "teleop sim --link gimbal=udp_multicast:239.74.163.2",
        "teleop sim --drone",
        "teleop sim --replay bus.log --link gimbal=udp_multicast:239.74.163.2",
    ],
    "schema": ["teleop schema sequence"],
    "decode": ["teleop decode r-sdk aa1a0003..."],
    "decode r-sdk": ["teleop decode r-sdk aa1a0003...", "teleop decode r-sdk --candump log.txt"],
    "decode onboard": ["teleop decode onboard --model m100 aa1a0003...", "teleop decode onboard --parts"],
    "decode hid": ["teleop decode hid --descriptor descriptor.bin 017f7f80"],
    "encode": ["teleop encode r-sdk"],
    "encode r-sdk": ["teleop encode r-sdk", "teleop encode r-sdk --can"],
    "encode onboard": ["teleop encode onboard"],
}


def examples(command: str) -> str:
    """For the end of a command's help."""
    return "\n".join(["Examples:", *(f"  {line}" for line in EXAMPLES[command])])
