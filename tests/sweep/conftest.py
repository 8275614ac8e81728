import pytest

QUICK = "t_end: 0.02, snapshots: 8, output_points: 16, tol: 1.0e-2"


@pytest.fixture
def sweep_file(tmp_path):
    """Writes a sweep of members that take a few hundredths of a second each."""

    def write(grid="p: [4, 8]", base="p: 4", more="", name="grid.yaml"):
        path = tmp_path / name
        path.write_text(f"base: {{{base}, {QUICK}}}\ngrid:\n  " + grid.replace("; ", "\n  ") + f"\n{more}\n")
        return path

    return write
