"""A class: a page and a folder for each student, and a board for the teacher."""
