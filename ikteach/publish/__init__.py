"""The course as files: delivered, built as pages or as a site, collected."""
