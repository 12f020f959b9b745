// @ts-check
/* The Images panel: what cameras see, each picture as large as its place allows. */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { pictures } from "../wire/pictures.js";
import { useRow } from "../state.js";

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
  useEffect(
    () =>
      pictures.follow(key, (bitmap, bad) => {
        /** @type {any} */
        const canvas = place.current?.querySelector("canvas");
        if (!canvas) return;
        canvas.width = bitmap?.width || 1;
        canvas.height = bitmap?.height || 1;
        if (bitmap) canvas.getContext("2d").drawImage(bitmap, 0, 0);
        setSize(bitmap ? `${bitmap.width} × ${bitmap.height}` : "");
        setBroken(bad);
      }),
    [key],
  );
  const none = broken ? "The browser cannot read this picture" : row?.value || "No image";
  return html`<section class="camera" aria-label=${row?.name}>
    <header class="title">${row?.name}<span class="size">${size}</span></header>
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
