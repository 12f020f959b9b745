// @ts-check
/* Starts the window and all that it follows. The view is there or not: nothing here asks for it. */

import { actAtOnce } from "./view/new_tool.js";
import { stopDrawing } from "./view/drag_tool.js";
import { html, render } from "./vendor/preact.js";
import { act, connect, HOVER, newGesture, rows, send } from "./wire/channel.js";
import { followConnection } from "./wire/connection.js";
import { followFullscreen, togglePanels } from "./window/splitters.js";
import { followFile } from "./window/files.js";
import { listenToKeys } from "./window/keys.js";
import { followPalette } from "./window/palette.js";
import { followPermalinks } from "./wire/permalink.js";
import { followDriving } from "./panels/drive.js";
import { drivesRobot, followLiveDriving } from "./panels/live_drive.js";
import { followByNumbers } from "./dialogs/by_numbers.js";
import { followGhost } from "./panels/poses.js";
import { play, seek } from "./window/player_bar.js";
import { tellView } from "./panels/views.js";
import { releaseKept } from "./cells/field.js";
import { cancelPress, followMouse, mousePlace } from "./view/pointer.js";
import { followClickedLink } from "./window/clicked_link.js";
import { followRole } from "./window/users.js";
import { tellControls, toolKeys } from "./window/toolbar.js";
import { Window } from "./window/window.js";

const start = () => {
  const host = document.createElement("div");
  host.id = "sambot";
  document.body.append(host);
  document.body.classList.add("sambot-window");
  render(html`<${Window} />`, host);
  const plays = () => rows.get("player/playing") !== undefined;
  listenToKeys({
    tools: toolKeys,
    mouse: mousePlace,
    act: actAtOnce,
    drivesRobot,
    hide: togglePanels,
    cancelPress: () => {
      stopDrawing();
      cancelPress();
    },
    plays,
    play,
    seek,
  });
  const hovering = newGesture();
  followMouse({
    wantsHover: () =>
      Boolean(rows.data("tools/list")?.some((/** @type {any} */ tool) => tool.hover)),
    // Of the places that wait, only the last one counts.
    hover: (place) => send(HOVER, place, hovering),
    rightClick: () => act(rows.data("tools/over")?.holds ? "tools/open_menu" : "tools/right_click"),
    twice: (place) => act("tools/double_click", place),
    enter: releaseKept,
  });
  tellView();
  tellControls();
  followClickedLink();
  followGhost();
  followDriving();
  followLiveDriving();
  followByNumbers();
  followFile();
  followFullscreen();
  followConnection();
  followRole();
  followPalette();
  followPermalinks();
  connect();
};
// The script may be there before the page's body is.
if (document.readyState !== "loading") start();
else addEventListener("DOMContentLoaded", start);
