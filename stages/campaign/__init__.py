"""What a campaign file says, made explicit: manoeuvres, what is known, how logs are read."""
