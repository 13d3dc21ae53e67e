// Search without a server: a page that is opened as a file may neither fetch the index nor start a worker.
"use strict";
var __search = {};
(() => {
  const base = new URL("..", document.currentScript.src);
  // search/search_index.js is about a megabyte, so it is loaded when the reader turns to the search.
  __search.index = new Promise((resolve) => {
    window.rigcalSearchIndex = resolve;
    let asked = false;
    const ask = () => {
      if (asked) return;
      asked = true;
      document.head.append(Object.assign(document.createElement("script"), {src: new URL("search/search_index.js", base)}));
    };
    addEventListener("keydown", (event) => { if (["f", "s", "/"].includes(event.key)) ask(); });
    for (const type of ["focusin", "input", "keyup"])
      addEventListener(type, (event) => { if (event.target.matches?.("[data-md-component=search-query]")) ask(); });
    addEventListener("change", (event) => { if (event.target.id === "__search") ask(); });
    if (new URL(location).searchParams.has("q")) ask();
  });
  if (location.protocol !== "file:") return;
  /** A frame that runs the script of a worker. */
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.waiting = [];
      this.frame = Object.assign(document.createElement("iframe"), {hidden: true, title: "search"});
      document.body.append(this.frame);
      const inside = this.frame.contentWindow;
      inside.postMessage = (data) => setTimeout(() => this.dispatchEvent(new MessageEvent("message", {data})));
      inside.document.body.append(Object.assign(inside.document.createElement("script"), {
        src: new URL(url, location),
        onload: () => { this.deliver = (data) => inside.dispatchEvent(new inside.MessageEvent("message", {data})); this.waiting.forEach(this.deliver); },
      }));
    }
    postMessage(data) { if (this.deliver) setTimeout(() => this.deliver(data)); else this.waiting.push(data); }
    terminate() { this.frame.remove(); }
  };
})();
