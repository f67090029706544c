// start.js -- the page of daguerre view.

import {Link} from './link.js';
import {mount} from './main.js';

mount(document, (handlers) => new Link(handlers));
