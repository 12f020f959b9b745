"""The display of camera pictures, in a panel of the page."""
