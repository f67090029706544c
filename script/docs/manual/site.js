// Adds what the theme leaves out for the keyboard and for screen readers: code and tables that scroll can have
// the focus; neither parts of the navigation nor the buttons of a block of code are landmarks; the empty corner
// of a table is no header.
function mend() {
  for (const part of document.querySelectorAll("pre > code, .md-typeset__scrollwrap")) part.tabIndex = 0;
  for (const nav of document.querySelectorAll(".md-nav .md-nav[aria-labelledby], .md-code__nav:not([role])")) {
    nav.removeAttribute("aria-labelledby");
    nav.removeAttribute("aria-expanded");
    nav.setAttribute("role", "none");
  }
  for (const cell of document.querySelectorAll("th:empty")) cell.replaceWith(document.createElement("td"));
}

mend();
new MutationObserver(mend).observe(document.body, { childList: true, subtree: true }); // the theme adds some later
