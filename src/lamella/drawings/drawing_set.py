"""drawings.pdf: all sheets of a structure, one after the other."""

from __future__ import annotations

from lamella.drawings.assembly import assembly_pages
from lamella.drawings.built import Built
from lamella.drawings.hub_detail import hub_pages
from lamella.drawings.joint_detail import joint_pages
from lamella.drawings.overview import overview_pages
from lamella.drawings.page import Page
from lamella.drawings.paper import PAPERS
from lamella.drawings.parts_list import list_pages
from lamella.drawings.pdf import pdf_bytes
from lamella.drawings.plate_sheets import plate_pages
from lamella.drawings.segment_sheets import segment_pages
from lamella.drawings.strip_sheets import strip_pages
from lamella.drawings.terms import terms

SHEETS = (overview_pages, joint_pages, hub_pages, plate_pages, strip_pages, assembly_pages, segment_pages, list_pages)
"""What is drawn, in the order of the sheets."""


def drawing_pages(built: Built, *, paper: str = "A3", language: str = "en") -> list[Page]:
    """The sheets of a structure.

    Parameters
    ----------
    built : Built
    paper : str
        "A3" or "A1".
    language : str
        One of `lamella.drawings.terms.languages`.
    """
    return [page for make in SHEETS for page in make(built, PAPERS[paper], terms(language))]


def drawings_pdf(built: Built, *, paper: str = "A3", language: str = "en") -> bytes:
    """The sheets of a structure as a PDF file, the same for the same input; parameters as of `drawing_pages`."""
    pages = drawing_pages(built, paper=paper, language=language)
    signed = {"name": built.name, "version": built.version, "material": built.material}
    return pdf_bytes(pages, PAPERS[paper], terms(language), **signed)
