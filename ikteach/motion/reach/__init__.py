"""Chapter 10. The human motion simulator of CS 490: packages of joints that reach for a cursor."""
