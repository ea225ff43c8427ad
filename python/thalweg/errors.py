"""What goes wrong with a run folder."""
import difflib


class RunFolderError(Exception):
    """One sentence about something the user can put right: which file, what is wrong, what to do."""


class MissingField(RunFolderError, AttributeError):
    """A field that a frame of the grains does not have, because the case leaves it out."""


class MissingName(KeyError):
    """A name that is not among those of some data; says which names are near, and all that there are."""

    def __init__(self, name, names, source="", hint=""):
        super().__init__(name)
        self.name, self.names, self.source, self.hint = name, list(names), source, hint

    def __str__(self):
        near = difflib.get_close_matches(str(self.name), self.names, 3, 0.5)
        text = f"{f'{self.source}: ' if self.source else ''}there is no {self.name!r}"
        text += f"; did you mean {' or '.join(near)}?" if near else "."
        return f"{text} There are: {', '.join(self.names) or 'none'}.{f' {self.hint}' if self.hint else ''}"
