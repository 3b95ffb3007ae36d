import pytest
from link_suite import LinkSuite

from teleop.core.errors import LinkError
from teleop.links.memory import pair


class TestMemory(LinkSuite):
    @pytest.fixture
    def ends(self):
        return pair()

    def test_what_had_arrived_survives_the_far_end(self) -> None:
        near, far = pair()
        far.send(b"last words")
        far.close()
        assert near.receive() == b"last words"
        with pytest.raises(LinkError, match="the far end of the cable is closed"):
            near.receive()
        with pytest.raises(LinkError, match="the far end"):
            near.send(b"x")
