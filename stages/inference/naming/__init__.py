"""Naming causes: which effects the equations ask for, and what cannot be told from them.

sought      an effect is its columns, for every value of its scan
evidence    what the equations of all sensors say of the columns
chance      what noise alone brings forth in this campaign, by simulation
causes      the causes, each with its class, by search and classes; named: what is said of them
refining    finer values of a scan where an effect was found
visible     what the campaign could have seen
structure   whether the residuals of the refit still have a structure
splitting   the manoeuvre that tells the members of a class apart
limits      the power that no search exceeds
"""
