"""Names of participants in figures: a name that a figure cannot show is numbered as in the table."""
import collections
import io
import pathlib
import sys
import unittest
import warnings

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "python"))
from tactus.analysis import plot_style

Curve = collections.namedtuple("Curve", "participant")
CURVES = [Curve(name) for name in ("", "P01", "Zoë", "Ελένη", "Анна", "مريم", "小明", "प्रिया")]


class NamesInFigures(unittest.TestCase):
    def test_a_name_that_the_figure_cannot_show_has_its_number_in_the_table(self):
        self.assertEqual([plot_style.label_of(c.participant, CURVES) for c in CURVES],
                         ["all together", "P01", "Zoë", "Ελένη", "Анна", "participant 5", "participant 6", "participant 7"])
        self.assertEqual([plot_style.name_in_table(c.participant, CURVES) for c in CURVES],
                         ["all together", "P01", "Zoë", "Ελένη", "Анна", "5: مريم", "6: 小明", "7: प्रिया"])

    def test_no_title_lacks_a_glyph(self):
        fig, axes = plot_style.figures.new()
        axes.set_title(", ".join(plot_style.label_of(c.participant, CURVES) for c in CURVES))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            fig.savefig(io.BytesIO(), format="png")
        plot_style.figures.plt.close(fig)


if __name__ == "__main__":
    unittest.main()
