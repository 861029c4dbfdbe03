// What a reader does with the view in space, and what must come of it. in_browser.sh puts it at the end of a page,
// behind a script that collects errors in `pageErrors`; the verdict goes into the page.
(() => {
  const failures = [];
  let checks = 0;
  const check = (holds, what) => {
    ++checks;
    if (!holds) failures.push(what);
  };
  const section = document.getElementById("view"), canvas = section.querySelector("canvas");
  const part = (name) => section.querySelector(`[data-part="${name}"]`);
  const gl = canvas.getContext("webgl2");

  function picture() {
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return new Uint32Array(pixels.buffer);
  }
  // Share of the pixels that are not the same.
  const difference = (a, b) => a.reduce((count, colour, k) => count + (colour !== b[k]), 0) / a.length;
  const say = (element, type) => element.dispatchEvent(new Event(type, { bubbles: true }));
  function set(name, value) {
    part(name).value = value;
    say(part(name), part(name).type === "range" ? "input" : "change");
    return picture();
  }
  const point = (type, id, x, y) => {
    const { left, top } = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent(type, { pointerId: id, clientX: left + x, clientY: top + y, buttons: 1 }));
  };

  canvas.setPointerCapture = () => {};  // there is no such pointer
  check(!section.hidden, "the view is hidden");
  check(gl !== null, "no WebGL 2");
  const end = picture(), colours = new Set(end);
  check(colours.size > 100, `only ${colours.size} colours: the view is empty`);
  check(end.filter((colour) => colour !== end[0]).length > 0.1 * end.length, "the view is nearly empty");

  const start = set("time", 0);
  check(difference(start, end) > 0.02, "the slider does not change the picture");
  check(part("clock").textContent === "0.00 s", `the clock says ${part("clock").textContent} at the start`);
  check(difference(set("time", 437), start) > 0.01, "between two frames the picture is that of the start");
  check(difference(set("time", 1000), end) === 0, "the end does not look the same again");

  const pictures = [...part("field").options].map((option) => set("field", option.value));
  check(pictures.length === 3, `${pictures.length} fields instead of 3`);
  for (let k = 1; k < pictures.length; ++k)
    check(difference(pictures[k], pictures[k - 1]) > 0.01, `field ${k} looks as the one before`);
  check(difference(set("field", 0), end) === 0, "the first field does not look the same again");
  check(part("legend").querySelectorAll(".view-band").length > 1, "the legend has no bands");

  for (const name of ["mold", "rig", "boundary"]) {
    part(name).click();
    check(difference(picture(), end) > 1e-3, `${name} cannot be hidden`);
    part(name).click();
  }
  point("pointermove", 9, 0.5 * canvas.clientWidth, 0.5 * canvas.clientHeight);
  check(part("readout").textContent.includes(" mm at u "), `no value below the pointer: "${part("readout").textContent}"`);
  point("pointerdown", 1, 100, 100);
  point("pointermove", 1, 160, 120);
  const turned = picture();
  check(difference(turned, end) > 0.05, "one pointer does not turn the view");
  point("pointerdown", 2, 200, 200);
  point("pointermove", 2, 260, 260);
  point("pointermove", 1, 100, 60);  // as far the other way: their middle stays
  check(difference(picture(), turned) > 0.05, "two pointers do not zoom");
  point("pointerup", 1, 0, 0);
  point("pointerup", 2, 0, 0);
  part("reset").click();
  check(difference(picture(), end) === 0, "the view is not reset");
  part("play").click();
  check(part("play").textContent === "Pause", "it does not play");
  part("play").click();
  check(part("play").textContent === "Play", "it does not pause");

  for (const error of window.pageErrors) check(false, error);
  const verdict = document.createElement("pre");
  verdict.textContent = `verdict: ${checks} checks, ${failures.length} failed\n${failures.join("\n")}`;
  document.body.append(verdict);
})();
