// The view of the body on the live page: one frame, which live_page.js replaces as new ones come.
import {BodyView, decode} from './body_view.js';

class LiveBodyView extends BodyView {
  // No time to choose: there is only now.
  tools() {
    const made = super.tools();
    const [time, frames] = made.children;
    time.remove();
    frames.remove();
    return made;
  }

  update({step, view}) {
    const {scale} = this;
    this.data.step = step;
    this.views = [{...view, u: decode(view.u, Int16Array)}];
    const force = this.metresPerNewton;
    this.measure();
    // Scales only widen, so that what is small looks small.
    this.scale = Math.max(scale, this.scale);
    if (force > 0 && this.metresPerNewton > 0) {
      this.metresPerNewton = Math.min(force, this.metresPerNewton);
    } else {
      this.metresPerNewton ||= force;
    }
    if (this.scale !== scale) this.place.querySelector('.ramp').replaceWith(this.ramp());
    this.show(0);
  }
}

window.softforceBody = (place, data) => new LiveBodyView(place, data);
