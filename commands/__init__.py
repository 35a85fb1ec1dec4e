"""What a person calls: check, trace, and the pages of docs that the code makes."""
