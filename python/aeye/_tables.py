"""Results that are rows."""

import importlib
from typing import Any

from aeye._errors import EngineError


class Table(list[dict[str, Any]]):
    """Rows, each a dictionary: a plain list, with a short way to pandas."""

    def to_pandas(self) -> Any:
        """The rows as a `pandas.DataFrame`; what is nested has columns named `outer.inner`.

        Raises EngineError where pandas is not installed.
        """
        try:
            pandas = importlib.import_module("pandas")
        except ImportError as error:
            raise EngineError("pandas is not installed; expected it for to_pandas()") from error
        return pandas.json_normalize(list(self))
