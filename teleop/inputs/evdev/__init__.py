"""Linux event devices: the pads that the kernel's own drivers keep from hidraw, read as HID inputs."""
