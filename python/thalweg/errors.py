"""What goes wrong with a run folder."""


class RunFolderError(Exception):
    """One sentence about something the user can put right: which file, what is wrong, what to do."""
