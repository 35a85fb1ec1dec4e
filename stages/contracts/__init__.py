"""What passes a border: tables, campaign and settings, errors, the command line of a stage."""
