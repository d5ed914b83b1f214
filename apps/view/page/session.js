// The client of a live session. States come as fast as they are drawn: the page asks for the next
// one after it has drawn the last. A lost server is tried again each second.

const kRetry = 1000;  // ms

class Session {
  constructor(view, settings) {
    this.view = view;
    this.kind = settings.kind;
    this.address = (location.protocol === "https:" ? "wss://" : "ws://") + location.host +
        settings.socket + location.search;
    this.state = "connecting";  // then "writer", "watching" or "gone"
    this.last = null;           // the newest state of the server
    this.taken = false;         // the guest has done something; until then a motion is shown
    this.echo = 0;              // the newest event that has come back
    this.latencies = [];        // ms from a drag to the frame that shows its effect
    this.received = 0;
    this.soon = new Map();      // what goes out with the next frame
    this.connect();
  }

  get writer() {
    return this.state === "writer";
  }

  connect() {
    const socket = new WebSocket(this.address);
    this.socket = socket;
    listen(socket, {
      message: (event) => { if (socket === this.socket) this.receive(event.data); },
      close: () => { if (socket === this.socket) this.lose(); }});
  }

  lose() {
    this.become("gone");
    this.view.now.hand = null;
    this.view.moved();
    setTimeout(() => this.connect(), kRetry);
  }

  become(state) {
    if (this.state === state) return;
    this.state = state;
    this.view.emit("writer");
  }

  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    if (!["next", "write", "modes", "save"].includes(message.do)) this.taken = true;
    this.socket.send(JSON.stringify(message));
  }

  // Goes out with the next frame; of messages with the same key the newest alone.
  sendSoon(key, message) {
    if (!this.soon.size) {
      this.view.stage.after.push(() => {
        const messages = Array.from(this.soon.values());
        this.soon.clear();
        for (const one of messages) this.send(one);
      });
      this.view.stage.ask();
    }
    this.soon.set(key, message);
  }

  receive(text) {
    const message = JSON.parse(text);
    if (message.hello) this.greet(message.hello);
    if (message.writer !== undefined) this.become(message.writer ? "writer" : "watching");
    if (message.scene) this.reshape(message.scene);
    if (message.state) this.show(message.state);
    if (message.outcome) this.view.emit("outcome", message.outcome);
    if (message.note) this.view.say(message.note);
    if (message.refused) this.view.say(message.refused, true);
    if (message.modes) this.view.emit("modes", message);
    if (message.files) this.view.emit("files", message.files);
  }

  // From now on the mechanism is not that of a recorded motion.
  reshape(scene) {
    this.taken = true;
    this.view.reshape(scene);
  }

  // Another session under the same address shows another mechanism: the page is read anew.
  greet(hello) {
    if (this.id !== undefined && hello.session !== this.id) {
      location.reload();
      return;
    }
    this.id = hello.session;
    this.become(hello.writer ? "writer" : "watching");
    this.send({do: "next"});
  }

  show(state) {
    const {now, stage, history} = this.view;
    this.last = state;
    ++this.received;
    stage.after.push(() => this.drawn(state));
    this.view.emit("state", state);
    if (this.view.scene.motion && !this.taken) {
      stage.ask();
      return;
    }
    now.live = true;
    now.time = state.time;
    state.poses.forEach((pose, link) => now.poses.set(pose, 7 * link));
    now.coordinates.set(state.coordinates);
    if (state.rates) now.rates.set(state.rates);
    this.showWrenches(now, state);
    now.atLimit = state.at_limit || [];
    now.hand = state.hand || null;
    now.haptic = state.haptic || null;
    history.add(now);
    this.view.moved();
  }

  showWrenches(now, state) {
    if (state.wrenches) {
      now.wrenches = now.wrenches || new Float64Array(6 * this.view.scene.joints.length);
      state.wrenches.forEach((wrench, joint) => now.wrenches.set(wrench, 6 * joint));
    } else {
      now.wrenches = null;
    }
    if (state.certainty) now.certainty = state.certainty;
  }

  drawn(state) {
    if (state.echo > this.echo) {
      this.echo = state.echo;
      this.latencies.push(performance.now() - state.echo);
      if (this.latencies.length > kHistory) this.latencies.shift();
    }
    this.send({do: "next"});
  }
}
