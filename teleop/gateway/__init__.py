"""The gateway: the process through which a network reaches a rig. It may hang, fail or be killed; the rig goes on."""
