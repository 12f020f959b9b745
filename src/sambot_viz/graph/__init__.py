"""The graph of nodes and topics, expected or running, as rqt_graph draws it."""
