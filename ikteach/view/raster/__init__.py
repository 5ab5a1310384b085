"""The renderer in the kernel: still pictures and movies."""
