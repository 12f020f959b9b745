"""What is under the cursor, and the marks around what is selected."""
