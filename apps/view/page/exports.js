// Files that the page makes: a picture, the animation as glTF, a video.

const kVideoRate = 30;  // frames a second

class Exports {
  constructor(view) {
    this.view = view;
    this.recorder = null;
  }

  name(suffix) {
    return fileName(this.view.scene.title || "mechanism", suffix);
  }

  // The picture with its triad, as a canvas.
  picture() {
    const {stage} = this.view, copy = document.createElement("canvas");
    copy.width = stage.canvas.width;
    copy.height = stage.canvas.height;
    stage.draw();
    const pen = copy.getContext("2d");
    pen.drawImage(stage.canvas, 0, 0);
    pen.drawImage(stage.triad.canvas, 0, copy.height - stage.triad.canvas.height);
    return copy;
  }

  savePicture() {
    this.picture().toBlob((blob) => download(this.name(".png"), blob), "image/png");
  }

  saveGltf() {
    const text = JSON.stringify(new GltfWriter(this.view).write());
    download(this.name(".gltf"), new Blob([text], {type: "model/gltf+json"}));
  }

  // One passage or cycle, at the speed that is set; a second click ends it.
  toggleVideo(button) {
    if (this.recorder) {
      this.recorder.stop();
      return;
    }
    const {view} = this, {stage, player} = view, parts = [];
    const stream = stage.canvas.captureStream(kVideoRate);
    const recorder = new MediaRecorder(stream, {videoBitsPerSecond: 8e6});
    this.recorder = recorder;
    stage.recording = true;
    setText(button, "Stop");
    listen(recorder, {
      dataavailable: (event) => parts.push(event.data),
      stop: () => {
        this.recorder = null;
        stage.recording = false;
        clearTimeout(this.timer);
        setText(button, "Video");
        for (const track of stream.getTracks()) track.stop();
        const type = recorder.mimeType.split(";")[0] || "video/webm";
        download(this.name(type.endsWith("mp4") ? ".mp4" : ".webm"), new Blob(parts, {type}));
      }});
    recorder.start();
    if (!player.motion || view.live) return;
    player.goTo(0);
    player.play();
    const seconds = player.motion.duration / (player.speed * player.stretch);
    this.timer = setTimeout(() => { if (this.recorder === recorder) recorder.stop(); },
        1000 * seconds);
  }
}
