"""White noise of every channel in every manoeuvre, from the data, beside the data sheet's."""
