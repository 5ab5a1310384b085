// What is seen where the figure cannot live: why, and pictures that the kernel draws. The page asks
// for one when there is news, and leaves the kernel half of its time for everything else.

const PAUSE = 250; // [ms] at least, from a picture to the next question
const LOST = 10_000; // [ms] after which an answer counts as lost

function pictures({ model, el }) {
  let box = null, image = null, url = null;
  let news = -1, seen = -1; // numbers of frames
  let asked = null, pause = null; // when, and what ends the waiting

  function start(cause) {
    if (box) return;
    box = document.createElement("div");
    box.className = "ikteach-pictures";
    const style = document.createElement("style"), words = document.createElement("p");
    style.textContent = // in place of what pythreejs shows of its own failure
      `.ikteach-scene:has(.ikteach-pictures) > :first-child { display: none; }
       .ikteach-pictures > p { border-left: 4px solid #d55e00; padding: 4px 10px; margin: 4px 0; }`;
    words.setAttribute("role", "alert");
    words.textContent = model.get("lacking")[cause];
    image = document.createElement("img");
    image.alt = ""; // the words under it say what it shows
    image.style.maxWidth = "100%";
    box.append(style, words, image);
    el.prepend(box);
  }

  function stop() {
    clearTimeout(pause);
    if (url) URL.revokeObjectURL(url);
    box?.remove();
    box = url = asked = null;
  }

  function follow(frame) {
    news = frame;
    ask();
  }

  function ask() {
    if (!box || asked !== null || news === seen) return;
    asked = performance.now();
    pause = setTimeout(again, LOST);
    model.send({ picture: true });
  }

  function again() {
    asked = null;
    ask();
  }

  function put(frame, png) {
    if (!box || asked === null) return; // another page has asked
    seen = frame;
    if (url) URL.revokeObjectURL(url);
    url = image.src = URL.createObjectURL(new Blob([png], { type: "image/png" }));
    clearTimeout(pause);
    pause = setTimeout(again, Math.max(PAUSE, performance.now() - asked));
  }

  return { start, stop, follow, put, get on() { return box !== null; } };
}

function hasWebGL() {
  const gl = document.createElement("canvas").getContext("webgl");
  gl?.getExtension("WEBGL_lose_context")?.loseContext(); // a page may have few
  return gl !== null;
}

