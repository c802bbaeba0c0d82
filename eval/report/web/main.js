// Viewers are made when they come near the window: a page holds more images than memory likes.

const page = JSON.parse(document.getElementById("views").textContent);
const viewers = new Map();  // host -> Viewer

function makeViewer(host) {
  if (viewers.has(host)) return;
  const viewer = new Viewer(host, page.views[Number(host.dataset.view)], page.exponents);
  // One open list shows that there are keys; where a keyboard is unlikely, its heading does.
  if (viewers.size === 0) viewer.panel.keys.open = matchMedia("(min-width: 40rem)").matches;
  viewers.set(host, viewer);
}

function makeExplorer(host) {
  new Explorer(host, page.views[Number(host.dataset.view)], page.exponents);
}

const nearby = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    nearby.unobserve(entry.target);
    (entry.target.matches(".viewer") ? makeViewer : makeExplorer)(entry.target);
  }
}, {rootMargin: "800px"});
for (const host of document.querySelectorAll(".explorer")) nearby.observe(host);

let underPointer = null;
for (const host of document.querySelectorAll(".viewer")) {
  nearby.observe(host);
  host.addEventListener("pointerenter", () => { underPointer = host; });
  host.addEventListener("pointerleave", () => { underPointer = null; });
}

// Moves the viewer of a row's picture into `room`. Returns a function that moves it back.
let moveBack = null;
function showPicture(button, room) {
  moveBack?.();
  const host = document.querySelector(`.viewer[data-view="${button.dataset.view}"]`);
  const place = document.createComment("viewer");
  host.replaceWith(place);
  room.append(host);
  makeViewer(host);
  const viewer = viewers.get(host);
  viewer.choose("a", Number(button.dataset.image));
  if (viewer.reference >= 0) viewer.choose("b", viewer.reference);
  const back = () => {
    if (moveBack === back) moveBack = null;
    if (place.isConnected) place.replaceWith(host);
  };
  moveBack = back;
  return back;
}

for (const block of document.querySelectorAll(".block.filtered")) {
  new ResultTable(block, showPicture);
}

// Keys while nothing has the focus: for the viewer under the pointer.
document.addEventListener("keydown", (event) => {
  if (event.target === document.body) viewers.get(underPointer)?.key(event);
});
