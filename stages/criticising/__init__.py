"""From what the equations say of effects to causes, blind spots and findings in words."""
