"""What should agree: rests and turns, both ways of turning, methods, rates, published and ours."""
