"""The course as a server shows it: JupyterLab, pages without code, a class's answers."""
