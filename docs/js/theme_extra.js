// In place of the theme's own, which Debian's package lacks: tables as the theme draws them.
for (const table of document.querySelectorAll("table")) table.classList.add("docutils");
