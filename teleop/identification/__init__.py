"""Identifies how an axis answers its commands while it moves anyway. No I/O and no clock: times come with the values.

`ResponseEstimator` is one axis in one mode. Give it each speed that is sent (`sent`) and each reading (`read`), in the
operator's signs; `response` is what is known by then, with its doubts, and `sure` whether that is enough to rely on.
It is as useful on a recording as during a run: feed it the same two streams in the order of their times. A run takes
priors and gives its estimates by `devices.rig`: `open_rig(..., priors={Axis.PAN: Response(...)})`, and `rig.responses`
for the axes that have moved enough to be sure. In `app`, `SequenceRun.priors` and `LiveRun.priors` are handed on, and
`RunReport.responses` is what was found by the end.
"""
