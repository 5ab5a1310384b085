"""The renderer in the page: pythreejs, and the driver that moves it."""
