"""``python -m lamella``."""

from lamella.command.main import main

raise SystemExit(main())
