"""The door of a rig: what its control process and every other process share, and nothing else of either.

State goes out by a ring in a file (`ring`), commands come in by datagrams (`sockets`, `messages`). Nothing here waits.
"""
