"""Finding the manoeuvres of the plan in the logs: what moves, what rests, what belongs to which."""
