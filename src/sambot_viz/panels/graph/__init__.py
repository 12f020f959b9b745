"""The Graph panel: nodes and topics."""
