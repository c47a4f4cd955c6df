// The view of the body in a run's report: the frames that the page holds.
import {BodyView, element} from './body_view.js';

const place = document.getElementById('view');
try {
  new BodyView(place, JSON.parse(document.getElementById('body-data').textContent));
  place.dataset.ready = 'yes';
} catch (error) {
  place.replaceChildren(element('p', {
    className: 'soft',
    textContent: `The 3-D view needs a browser with WebGL (${error.message}).`,
  }));
  place.dataset.ready = 'no';
}
