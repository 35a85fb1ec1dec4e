"""What detectors of faults share: steps, lines, outliers, stamps, axes; arrays only."""
