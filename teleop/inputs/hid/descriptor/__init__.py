"""What a HID device sends: report descriptors and input reports, bytes in and controls out (HID 1.11)."""
