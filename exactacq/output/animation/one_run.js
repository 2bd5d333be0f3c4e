/** The page that plays one run, whose data it holds. */

import { $ } from "./player/dom.js";
import { player } from "./player/player.js";

const data = JSON.parse($("data").textContent);
const [across, down] = data.box;
document.title = data.title;
document.documentElement.style.setProperty("--tall", down / across);
$("title").textContent = data.title;
$("facts").textContent = player(data).facts;
