"""Finding the manoeuvres of the plan in a log: what moves, what rests, what belongs to which."""
