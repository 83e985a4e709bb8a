// A worker in a hidden frame, for pages that were opened from the disk: browsers start no worker there.
window.Worker = class FrameWorker extends EventTarget {
  constructor(url) {
    super();
    const frame = document.createElement("iframe");
    frame.hidden = true;
    frame.title = "search";
    document.body.append(frame);
    this.inside = frame.contentWindow;
    this.waiting = [];  // messages before the script was loaded
    this.inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
    const script = this.inside.document.createElement("script");
    script.src = new URL(url, location.href).href;
    script.addEventListener("load", () => { const waiting = this.waiting; this.waiting = undefined; waiting.forEach((m) => this.postMessage(m)); });
    this.inside.document.body.append(script);
  }
  postMessage(data) {
    if (this.waiting) this.waiting.push(data);
    else this.inside.dispatchEvent(new this.inside.MessageEvent("message", { data }));
  }
  terminate() { this.inside.frameElement.remove(); }
};
