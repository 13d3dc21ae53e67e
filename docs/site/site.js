// What the pages add to the theme.
"use strict";

// The copy button of a console block takes the commands, without prompts and output.
for (const code of document.querySelectorAll(".language-console code, .highlight code")) {
  if (!code.querySelector(".gp")) continue;
  const copy = code.cloneNode(true);
  for (const other of copy.querySelectorAll(".gp, .go")) other.remove();
  const commands = copy.textContent.split("\n").filter((line) => line.trim()).join("\n");
  code.dataset.commands = commands;
}
document.addEventListener("click", (event) => {
  const button = event.target.closest?.("[data-clipboard-target]");
  const commands = button && document.querySelector(button.dataset.clipboardTarget)?.dataset.commands;
  if (commands) button.dataset.clipboardText = commands;
}, true);

// The live rig says how high it is, so that the page scrolls and not the frame.
addEventListener("message", ({data, source}) => {
  if (typeof data?.rigcalHeight !== "number") return;
  for (const frame of document.querySelectorAll("iframe.live-rig"))
    if (frame.contentWindow === source) frame.style.height = `${Math.ceil(data.rigcalHeight)}px`;
});
