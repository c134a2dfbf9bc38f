"""``python -m lamella``."""

from lamella.cli import main

raise SystemExit(main())
