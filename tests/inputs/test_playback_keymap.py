"""The keys of a sequence that plays, as a terminal sends them: whole, in pieces, and with a trim."""

from teleop.core.axes import Axis
from teleop.core.operator_input import Command, Press
from teleop.inputs.keymaps import JogStep
from teleop.inputs.playback_keymap import TRIM_KEYS, PlayKeys

STOP, CLEAR = Press(Command.STOP), Press(Command.CLEAR)
PAUSE, FASTER, SLOWER = Press(Command.PAUSE), Press(Command.FASTER), Press(Command.SLOWER)
NEXT, PREVIOUS, GO, QUIT = Press(Command.NEXT), Press(Command.PREVIOUS), Press(Command.GO), Press(Command.QUIT)


def test_keys_whole_and_in_pieces():
    reader = PlayKeys()
    assert list(reader.feed("q\ng\r")) == [QUIT, GO, GO, GO]
    assert list(reader.feed(" xcp+\x1b[C<")) == [STOP, CLEAR, PAUSE, FASTER, NEXT, PREVIOUS]
    assert list(reader.feed("\x1b[")) == []
    assert reader.is_waiting
    assert list(reader.feed("D-")) == [PREVIOUS, SLOWER]
    assert list(reader.feed("\x1b")) == []
    reader.settle()
    assert list(reader.feed("p")) == [PAUSE]


def test_with_a_trim_arrows_and_letters_move_an_axis_on_and_the_rest_stays():
    reader = PlayKeys(TRIM_KEYS)
    assert list(reader.feed("\x1b[C\x1b[1;2A\x1b[1;5D\x1bOB")) == [
        JogStep(Axis.PAN, 1.0),
        JogStep(Axis.TILT, 10.0),
        JogStep(Axis.PAN, -0.1),
        JogStep(Axis.TILT, -1.0),
    ]
    assert list(reader.feed("hL]()")) == [
        JogStep(Axis.PAN, -0.1),
        JogStep(Axis.PAN, 10.0),
        JogStep(Axis.FOCUS, 0.01),
        JogStep(Axis.ROLL, -1.0),
        JogStep(Axis.ROLL, 1.0),
    ]
    asked = [Press(each) for each in (Command.RECENTER, Command.KEEP, Command.RANGE)]
    assert list(reader.feed("zwv >q")) == [*asked, STOP, NEXT, QUIT]
