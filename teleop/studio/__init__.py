"""Several rigs at once, by Zenoh: what both sides share, and the operator's side.

A rig's side is `teleop.exchange.zenoh`, in its gateway. The operator's side has threads of its own and no event loop,
so that a command, a program and a gateway use it alike.
"""
