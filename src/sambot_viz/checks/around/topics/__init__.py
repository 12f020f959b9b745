"""Rules about topics, which one node publishes and others read, also over bridges."""
