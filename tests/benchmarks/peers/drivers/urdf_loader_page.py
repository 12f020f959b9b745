"""The npm package urdf-loader in the smallest page with three.js; files only."""

from __future__ import annotations

import functools
import http.server
import os
import threading
from pathlib import Path

from speak import model_argument, obey

PAGE = """<!doctype html><html><body style="margin:0"><script type="importmap">
{"imports": {"three": "/modules/three/build/three.module.js",
             "three/examples/": "/modules/three/examples/",
             "three/addons/": "/modules/three/examples/jsm/"}}
</script><script type="module">
import * as three from "three";
import URDFLoader from "/modules/urdf-loader/src/URDFLoader.js";
const scene = new three.Scene();
scene.background = new three.Color(0x303030);
const camera = new three.PerspectiveCamera(45, innerWidth / innerHeight, 0.01, 1000);
const drawn = new three.WebGLRenderer({ antialias: true });
drawn.setSize(innerWidth, innerHeight);
document.body.append(drawn.domElement);
scene.add(new three.HemisphereLight(0xffffff, 0x808080, 3));
new URDFLoader(new three.LoadingManager()).load("/model/NAME", robot => {
  robot.rotation.x = -Math.PI / 2;
  scene.add(robot);
  window.robot = robot;
  const show = () => {
    const box = new three.Box3().setFromObject(robot);
    const centre = box.getCenter(new three.Vector3());
    const size = box.getSize(new three.Vector3()).length() || 1;
    camera.position.copy(centre).add(new three.Vector3(size, size, size));
    camera.lookAt(centre);
  };
  show();
  const draw = () => { drawn.render(scene, camera); requestAnimationFrame(draw); };
  draw();
});
</script></body></html>"""

model = Path(model_argument())
modules = Path(os.environ["NODE_MODULES"])


class Files(http.server.SimpleHTTPRequestHandler):
    """The page, the modules and the model's folder."""

    def translate_path(self, path: str) -> str:
        """Map the two folders."""
        path = path.partition("?")[0]
        for prefix, folder in (("/modules/", modules), ("/model/", model.parent)):
            if path.startswith(prefix):
                return str(folder / path[len(prefix) :])
        return str(model.parent / "nothing")

    def do_GET(self) -> None:
        """Answer the page by itself."""
        if self.path.partition("?")[0] != "/":
            super().do_GET()
            return
        page = PAGE.replace("NAME", model.name).encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(page)))
        self.end_headers()
        self.wfile.write(page)

    def log_message(self, *words: object) -> None:
        """Say nothing."""


server = http.server.ThreadingHTTPServer(
    ("127.0.0.1", 0), functools.partial(Files, directory=str(model.parent))
)
threading.Thread(target=server.serve_forever, daemon=True).start()
obey(f"http://127.0.0.1:{server.server_port}/", [])
