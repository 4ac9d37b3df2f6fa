// Legend buttons hide and show curves; the buttons at its right choose the measure of error.
for (const button of document.querySelectorAll(".legend button[data-name]")) {
  button.addEventListener("click", () => {
    const shown = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", shown);
    for (const curve of document.querySelectorAll(`.curve[data-name="${button.dataset.name}"]`))
      curve.style.display = shown ? "" : "none";
  });
}
for (const button of document.querySelectorAll(".legend button[data-measure]")) {
  button.addEventListener("click", () => {
    for (const other of document.querySelectorAll(".legend button[data-measure]"))
      other.setAttribute("aria-pressed", other === button);
    for (const plot of document.querySelectorAll("svg[data-measure]"))
      plot.toggleAttribute("hidden", plot.dataset.measure !== button.dataset.measure);
  });
}
