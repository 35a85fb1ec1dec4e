"""A campaign on a table, as a laboratory would write it: a rest and a turn."""

BY_TABLE = """\
campaign: 1
instrument: span-cpt
serial: "A-017"
date: "2026-11-02"
site: {latitude_deg: 30.5278, height_m: 24, gravity_m_s2: 9.7936174, gravity_sigma_m_s2: 5.0e-5}
table: {name: three-axis, position_sigma_arcsec: 2, angle_sigma_arcsec: 2}
log: session.asc
plan:
  - {id: x-up, do: rest, up: +x, seconds: 300}
  - {id: x-forward, do: turn, up: +x, degrees: 360, rate_deg_s: 10, accel_deg_s2: 5}
"""
