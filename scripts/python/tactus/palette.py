"""Colours of all figures: those of Okabe and Ito (Color Universal Design, 2008), which people with any colour vision distinguish. The live page has the
same for each modality (scripts/live/page/src/page.css). A name, a mark or a line style goes with each colour."""
BLACK, ORANGE, SKY_BLUE, GREEN, YELLOW, BLUE, VERMILLION, PURPLE = "#000000", "#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7"
GREY, PALE_GREY = "#555555", "#bab0ac"

MODALITY = {"simulation": GREY, "haptic": VERMILLION, "haptic_push": "#f0c4a8", "audio": BLUE, "visual": GREEN, "thermal": ORANGE}
PHASE = {"collision": BLUE, "solve": SKY_BLUE, "integrate": PURPLE, "decode": YELLOW, "render": GREEN, "other": PALE_GREY}
# Several logs, sources or series in one figure.
SERIES = ("#222222", PURPLE, SKY_BLUE, ORANGE, GREEN, BLUE)
BANDS = (BLUE, ORANGE, GREEN, PURPLE, SKY_BLUE, VERMILLION, PALE_GREY)
LIMIT = {"detect": BLUE, "appear": ORANGE, "break": VERMILLION}
