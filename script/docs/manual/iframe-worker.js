// Runs the search of the manual where a page is opened from disk: browsers start no worker there, so
// a hidden frame stands in for one. Loaded before the theme, which then finds it as Worker.
(() => {
  if (location.protocol !== "file:") return;

  class FrameWorker extends EventTarget {
    constructor(url) {
      super();
      this.url = url;
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.appendChild(this.frame);
      this.frame.receive = (data) => {
        setTimeout(() => {
          const message = new MessageEvent("message", { data });
          this.dispatchEvent(message);
          if (this.onmessage) this.onmessage(message);
        });
      };
      this.ready = new Promise((resolve) => {
        this.frame.started = resolve;
      });
      const inside = this.frame.contentDocument;
      inside.open();
      inside.write(
        "<!doctype html><body><script>" +
          "window.postMessage = (data) => frameElement.receive(data);" +
          "window.deliver = (data) => dispatchEvent(new MessageEvent('message', { data }));" +
          `<\/script><script src="${url}"><\/script>` +
          "<script>frameElement.started();<\/script></body>",
      );
      inside.close();
    }

    postMessage(data) {
      this.ready.then(() => this.frame.contentWindow.deliver(data));
    }

    terminate() {
      this.frame.remove();
    }
  }

  window.Worker = FrameWorker;
})();
