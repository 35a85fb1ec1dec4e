"""Which effects the data support, and what cannot be distinguished from them; arrays only."""
