"""The studio: a page on this machine on which a project is designed, and the server behind it.

`server` answers the page and programs, `session` holds the project's text and its history, `worker` computes frames:
`warm_frame` while something is dragged, `exact_frame` when it is let go.
"""
