// @ts-check
/* The Images panel: what cameras see, each picture as large as its place allows. */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { pictures } from "../wire/pictures.js";
import { useRow } from "../state.js";
import { SceneCamera } from "../view/scene_camera.js";

export function ImagesPanel() {
  useRow("panel:images");
  const ids = rows.panels.get("images") || [];
  return html`<div class="images">
    ${ids.map((id) => html`<${Camera} key=${id} id=${id} />`)}
  </div>`;
}

/** @param {{id: string}} props of a row */
function Camera({ id }) {
  const row = useRow(id);
  /** @type {Ref} */
  const place = useRef(null);
  const [seen, setSeen] = useState(false);
  const [size, setSize] = useState("");
  const [broken, setBroken] = useState(false);
  const key = row?.picture;
  // Pictures are decoded and sent only while somebody can see them.
  useEffect(() => {
    const observer = new IntersectionObserver((entries) =>
      setSeen(entries[entries.length - 1].isIntersecting),
    );
    observer.observe(place.current);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    if (key && seen) return showWhileVisible(key);
  }, [key, seen]);
  /** @type {{current: SceneCamera | null}} */
  const camera = useRef(null);
  useEffect(() => {
    const made = (camera.current = new SceneCamera(place.current));
    const end = pictures.follow(key, (bitmap, bad, view) => {
      made.show(bitmap, view);
      setSize(bitmap ? `${bitmap.width} × ${bitmap.height}` : "");
      setBroken(bad);
    });
    return () => {
      end();
      made.close();
    };
  }, [key]);
  useEffect(() => camera.current?.follow(seen), [key, seen]);
  const none = broken ? "The browser cannot read this picture" : row?.value || "No image";
  return html`<section class="camera" aria-label=${row?.name}>
    <header class="title">${row?.name}<span class="size">${size}</span></header>
    ${size && row?.value && html`<p class="doubt">${row.value}</p>`}
    <div class="picture" ref=${place}>
      <canvas role="img" aria-label=${`Picture of ${row?.name}`} hidden=${!size}></canvas>
      ${!size && html`<p>${none}</p>`}
    </div>
  </section>`;
}

/** Have the pictures of a display sent, but for the time in which the page is hidden; returns a
 * function that ends that. @param {string} key */
function showWhileVisible(key) {
  const tell = () => act("images/show", [key, document.visibilityState === "visible"]);
  tell();
  document.addEventListener("visibilitychange", tell);
  // After a new connection the server does not know any more what is shown.
  const end = rows.listen("whole:browser", tell);
  return () => {
    document.removeEventListener("visibilitychange", tell);
    end();
    act("images/show", [key, false]);
  };
}
