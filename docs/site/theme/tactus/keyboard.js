// Areas that scroll are reached by Tab, so that the arrow keys scroll them.
document.querySelectorAll(".md-search__scrollwrap, .md-typeset__scrollwrap").forEach((e) => { e.tabIndex = 0; });
