"""Check many sequences against one rig: print the length of those that it can play, and why it cannot play the others.

    python check_many.py                       some shipped sequences, on the profile rs2
    python check_many.py rs2 shoot/*.yaml      your own

Nothing is opened, and nothing moves.
"""

import sys

import teleop

rig, *sequences = sys.argv[1:] or ["rs2", "nudge", "reveal", "whip-pan"]
playable = 0
for sequence in sequences:
    try:
        move = teleop.plan(sequence, rig)
    except teleop.DocumentError as error:  # a mistake in the file, or a move that this rig cannot make
        print(f"no   {sequence}: {error}")
    else:
        playable += 1
        print(f"yes  {sequence}: {move.title}, {move.duration:.1f} s")

print(f"{rig} can play {playable} of {len(sequences)}")
