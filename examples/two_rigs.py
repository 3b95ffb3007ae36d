"""Play one move on two rigs at once, a thread each.

    python two_rigs.py

Each rig has its own control loop, links and clock. Give real rigs different links, as in `links={"gimbal": ...}`.
"""

from concurrent.futures import ThreadPoolExecutor

import teleop

MOVE = {"title": "Cross", "keyframes": [{"at": 0, "pan": -15, "tilt": 0}, {"at": 5, "pan": 15, "tilt": 8}]}


def play(mirrored: bool) -> tuple[teleop.Report, dict[str, float]]:
    keyframes = [{**key, "pan": -key["pan"]} if mirrored else key for key in MOVE["keyframes"]]
    with teleop.open("sim", virtual=True) as rig:
        report = rig.play({**MOVE, "keyframes": keyframes})
        return report, rig.angles()


with ThreadPoolExecutor() as threads:
    for name, (report, angles) in zip(("left", "right"), threads.map(play, (False, True)), strict=True):
        print(f"{name}: {'done' if report.ok else report.reason}, now at pan {angles['pan']:.1f}")
