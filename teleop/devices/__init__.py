"""What a profile names, opened: gimbal, focus motor, camera and drone on their links."""
