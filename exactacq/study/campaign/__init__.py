"""Random exact scenes by the thousand through a strategy, the audit and the checks of all claims.

`settings` says what is asked, `judging` judges scenes, in processes of their own on this machine, and
`cluster` on a dask cluster; `store` holds the results, `coordinator` brings them together, `summary` and
`table` tell them, `command` is the command line's.
"""
