"""What a stage is: one object that knows all that is particular to it.

Running a project, checking it, the command line's help, summary.json, its schema, the report and the documentation are
loops over stages. A new stage is a folder with such an object and a line in `lamella.stages.all_stages`.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.project.tables import Project
from lamella.stages.figure import Figure
from lamella.stages.memory import Memory, content_key
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.view.scene.scene import Shown


Out = TypeVar("Out")
Made = TypeVar("Made")


@dataclass(frozen=True)
class File:
    """A file of a run.

    Attributes
    ----------
    name : str
        Below the run's folder, with "/" between folders.
    write : callable
        Writes it to a path.
    also : tuple of str
        Names of further files that the same call writes.
    """

    name: str
    write: Callable[[Path], object]
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class Missing:
    """Why a project has no such stage.

    Attributes
    ----------
    needs : str
        What it would need: "a net of lamellas".
    reason : str
        Why there is none.
    remedy, where : str
        Of the error where the stage was requested.
    unasked : bool
        Whether nothing in the project asks for it, so that a run without it is a whole one.
    """

    needs: str
    reason: str
    remedy: str
    where: str
    unasked: bool = False


@dataclass(frozen=True)
class Estimate:
    """What can be said of a stage before it is run.

    Attributes
    ----------
    figures : dict
        Numbers by name, "nodes" for one.
    unknown : tuple of str
        What only a run can tell.
    """

    figures: Mapping[str, Any]
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True)
class Upstream:
    """What a stage may use: the project, and what the stages before it have computed.

    Attributes
    ----------
    project : Project
        With those defaults filled in that follow from its other values.
    folder : Path
        Where the files a project names are looked for.
    outputs : mapping
        By stage.
    figures : mapping
        Of each stage's summary, by stage.
    wanted : tuple of str
        Stages of this computation.
    finer : float
        By how much smaller the surface's tolerance is that its errors are judged by: a check judges coarse elements by
        the tolerance of the run.
    memory : Memory
    keys : mapping
        What the output of each stage is remembered by.
    checking : bool
        Whether this is a check, which takes seconds.
    """

    project: Project
    folder: Path
    outputs: Mapping[str, Any]
    figures: Mapping[str, Mapping[str, Any]]
    wanted: tuple[str, ...]
    finer: float
    memory: Memory
    keys: Mapping[str, str]
    checking: bool = False

    @property
    def surface(self) -> Surface[Any]:
        """The surface of the first stage."""
        surface: Surface[Any] = self.outputs["surface"].surface
        return surface

    def content(self, reads: Iterable[str]) -> str:
        """Hash of the values of some tables or keys of the project, and of the files they name."""
        return content_key(self.project, reads, (), self.folder)

    def remembered(self, name: str, decided_by: Hashable, make: Callable[[], Made]) -> Made:
        """A part of a stage's output that depends on less than the whole output does.

        Parameters
        ----------
        name : str
            Of the part.
        decided_by : hashable
            The values that decide it, besides the code.
        make : callable
        """
        return self.memory.remembered(name, repr(decided_by), make)


class Stage(Generic[Out]):
    """A stage of a run. What is not needed is left as it is here.

    Attributes
    ----------
    name : str
        As in `--until` and in summary.json.
    needs : tuple of str
        Stages whose output it uses.
    writes : tuple of (names, description)
        Files, for the help and the documentation; Markdown.
    figures : tuple of Figure
    report : (section, tuple of str)
        Heading and keys of the report's table.
    sliders : tuple of str
        Names of the frames that its scene may have; of those with a second word the first.
    quantities : tuple of str
        Keys of what its scene's layers may be coloured by.
    """

    name: ClassVar[str]
    needs: ClassVar[tuple[str, ...]] = ()
    writes: ClassVar[tuple[tuple[str, str], ...]] = ()
    figures: ClassVar[tuple[Figure[Any], ...]] = ()
    report: ClassVar[tuple[str, tuple[str, ...]]] = ("", ())
    sliders: ClassVar[tuple[str, ...]] = ()
    quantities: ClassVar[tuple[str, ...]] = ()

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        """Tables or keys of the project that decide the output, of a computation of some stages."""
        return ()

    def warned_by(self, project: Project) -> tuple[str, ...]:
        """Further tables or keys that decide its warnings."""
        return ()

    def missing(self, project: Project) -> Missing | None:
        """Why a project has no such stage; None where it has."""
        return None

    def ends(self, up: Upstream) -> Message | None:
        """Why there can be no such stage on what has been computed so far; None where there can."""
        return None

    def check(self, project: Project, surface: Surface[Any] | None) -> None:
        """Refuse what can be refused at no cost, before any stage is run.

        Parameters
        ----------
        project : Project
        surface : Surface or None
            None before it is known; all stages are asked again once it is.

        Raises
        ------
        InputError
        """

    def estimate(self, up: Upstream, progress: Progress) -> Estimate:
        """What can be said before it is run, in seconds."""
        return Estimate({})

    def takes_long(self, up: Upstream) -> str:
        """What only a run can tell, where this stage takes longer than a check may; empty where it does not."""
        return ""

    def heading(self, up: Upstream) -> str:
        """What is about to be done."""
        return ""

    def run(self, up: Upstream, progress: Progress) -> Out:
        """Compute the output.

        Raises
        ------
        InputError
            What the user can mend.
        """
        raise NotImplementedError

    def filled(self, up: Upstream, out: Out) -> Project:
        """The project with those defaults filled in that follow from the output."""
        return up.project

    def result(self, figures: Mapping[str, Any], out: Out) -> str:
        """What has come out, in half a line."""
        return ""

    def warnings(self, out: Out, up: Upstream, progress: Progress) -> Iterator[Message]:
        """What is computed rightly and yet should make the designer look twice."""
        return iter(())

    def files(self, out: Out, up: Upstream) -> Iterator[File]:
        """Files, in the order they are written."""
        return iter(())

    def model(self, out: Out, up: Upstream) -> Iterator[DrawnLayer]:
        """Layers that the stage adds to the files of the model: model.3dm, model.glb."""
        return iter(())

    def scene(self, out: Out, up: Upstream) -> Iterator[Shown]:
        """What the stage adds to the view: layers, frames of sliders, labels, marks, curves, remarks.

        Parameters
        ----------
        out
            The stage's output.
        up : Upstream
            With the outputs of all stages that were run, those after it too.
        """
        return iter(())

    def still(self, out: Out, up: Upstream) -> Iterator[Shown]:
        """What the stage adds to a picture: that of the view, where a picture need not hold less."""
        return self.scene(out, up)
