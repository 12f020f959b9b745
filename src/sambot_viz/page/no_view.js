// @ts-check
/* A page without a view: the window round an empty place, for what cannot draw or need not. */

import "./wire/viser_socket.js";
import "./start.js";
