// @ts-check
/* Asks who opens the page of a class. The name goes to the server in a header, which no page of
 * another origin can send; the answer brings the cookie by which it knows this browser again. */

import { html, render, useState } from "../vendor/preact.js";

/** The server's limit is the same [characters]. */
const LONGEST = 40;

/** Why the server does not take a name; "" when it does. @param {string} name */
async function join(name) {
  try {
    const headers = { "Sambot-Class": encodeURIComponent(name) };
    const answer = await fetch("join", { headers });
    return answer.ok ? "" : await answer.text();
  } catch {
    return "the server of the class does not answer; try again";
  }
}

function NameForm() {
  const [why, setWhy] = useState("");
  const [asks, setAsks] = useState(false);
  const send = async (/** @type {Event} */ event) => {
    event.preventDefault();
    /** @type {HTMLInputElement | null} */
    const field = /** @type {HTMLFormElement} */ (event.target).querySelector("input");
    setAsks(true);
    const said = await join(field?.value || "");
    if (!said) location.reload();
    else {
      setWhy(said[0].toUpperCase() + said.slice(1));
      setAsks(false);
    }
  };
  return html`<form class="name" onSubmit=${send}>
    <h1>${document.title}</h1>
    <label>Your name
      <input name="name" required autofocus autocomplete="name" maxlength=${LONGEST} /></label>
    <button class="main" disabled=${asks}>Begin</button>
    ${why && html`<p class="error" role="alert">${why}</p>`}
    <p class="soft">The teacher sees your name and what you write. Your text is kept: come again
      with this browser, and you go on where you were.</p>
  </form>`;
}

render(html`<${NameForm} />`, document.body);
