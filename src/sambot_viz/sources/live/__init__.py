"""What live sources share, whatever their transport."""
