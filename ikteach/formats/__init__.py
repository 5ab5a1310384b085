"""Files: movies and recorded sessions. Thin layers on libraries, imported only when used."""
