"""The course as a server shows it: JupyterLab, and figures as web pages without code."""
