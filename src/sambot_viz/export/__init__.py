"""Pictures and pages for people who are not at this machine."""
