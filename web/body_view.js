// The body of a run in three dimensions: its deformed surface in the frames that it is given,
// coloured by displacement, with forces, markers, cables and the robot's frame.
import {
  AmbientLight, BackSide, BufferAttribute, BufferGeometry, Color, ConeGeometry, CylinderGeometry,
  DirectionalLight, DoubleSide, Group, InstancedMesh, Line, LineBasicMaterial, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Scene, SphereGeometry,
  Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const UP = new Vector3(0, 1, 0);  // the axis of three.js's cylinders and cones
const VIRIDIS = ['#440154', '#443983', '#31688e', '#21918c', '#35b779', '#90d743', '#fde725'];
const AXES = [['x', '#d55e00'], ['y', '#009e73'], ['z', '#0072b2']];
const FRAMES_PER_SECOND = 15;  // when playing

export function decode(text, Type) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Type(bytes.buffer);
}

export function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// Pairs of nodes, every edge once.
function edgesOf(triangles) {
  const seen = new Set();
  const edges = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = Math.min(triangles[t + k], triangles[t + (k + 1) % 3]);
      const b = Math.max(triangles[t + k], triangles[t + (k + 1) % 3]);
      const key = a * 4294967296 + b;
      if (!seen.has(key)) {
        seen.add(key);
        edges.push(a, b);
      }
    }
  }
  return edges;
}

function roundUp(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].map((digit) => digit * power).find((step) => step >= value * (1 - 1e-9));
}

export class BodyView {
  constructor(place, data) {
    this.place = place;
    this.data = data;
    this.rest = decode(data.nodes, Float32Array);
    this.triangles = decode(data.triangles, Uint32Array);
    this.views = data.views.map((view) => ({...view, u: decode(view.u, Int16Array)}));
    this.factor = 1;
    this.shown = data.first;
    this.measure();
    this.canvas = element('canvas', {tabIndex: 0});
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', 'The deformed body with forces and markers');
    this.renderer = new WebGLRenderer(
        {canvas: this.canvas, antialias: true, preserveDrawingBuffer: true});  // for print
    this.labels = element('div', {className: 'labels'});
    place.append(this.canvas, this.ramp(), this.labels, this.tools());
    this.build();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.target.copy(this.centre);
    this.controls.addEventListener('change', () => this.render());
    this.standBack();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.paint());
    this.resize();
    this.paint();
    this.show(this.shown);
  }

  // Size of the body, and the largest displacement and force of all views.
  measure() {
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    const p = new Vector3();
    for (let i = 0; i < this.rest.length; i += 3) {
      p.fromArray(this.rest, i);
      low.min(p);
      high.max(p);
    }
    this.centre = low.clone().add(high).multiplyScalar(0.5);
    this.size = high.clone().sub(low).length();
    let square = 0;
    let force = 0;
    for (const view of this.views) {
      for (let i = 0; i < view.u.length; i += 3) {
        square = Math.max(square, view.u[i] ** 2 + view.u[i + 1] ** 2 + view.u[i + 2] ** 2);
      }
      for (const f of view.forces) force = Math.max(force, Math.hypot(f[4], f[5], f[6]));
    }
    // Below a tenth of a millimetre there is but noise.
    this.scale = roundUp(Math.max(Math.sqrt(square) * this.data.step, 1e-4));
    this.metresPerNewton = force > 0 ? 0.3 * this.size / force : 0;
  }

  build() {
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 16 / 9, this.size / 100, this.size * 100);
    this.camera.up.set(0, 0, 1);
    const lamp = new DirectionalLight(0xffffff, 1.5);
    lamp.position.set(-0.4, 0.6, 1);
    this.camera.add(lamp, lamp.target);
    lamp.target.position.set(0, 0, -1);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 1.7));

    this.position = new BufferAttribute(this.rest.slice(), 3);
    this.colour = new BufferAttribute(new Float32Array(this.rest.length), 3);
    const skin = new BufferGeometry();
    skin.setAttribute('position', this.position);
    skin.setAttribute('color', this.colour);
    skin.setIndex(new BufferAttribute(this.triangles, 1));
    this.skin = new Mesh(skin, new MeshLambertMaterial({
      vertexColors: true, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    }));
    const index = edgesOf(this.triangles);
    const net = new BufferGeometry();
    net.setAttribute('position', this.position);
    net.setIndex(index);
    this.net = new LineSegments(
        net, new LineBasicMaterial({color: 0x000000, transparent: true, opacity: 0.28}));
    const rest = new BufferGeometry();
    rest.setAttribute('position', new BufferAttribute(this.rest, 3));
    rest.setIndex(index);
    this.restNet = new LineSegments(rest, new LineBasicMaterial({transparent: true, opacity: 0.3}));
    this.restNet.visible = false;
    this.markers = new Group();
    this.forces = new Group();
    this.cables = new Group();
    this.axes = new Group();
    for (const [k, [, colour]] of AXES.entries()) {
      const end = new Vector3().setComponent(k, 0.12 * this.size);
      this.axes.add(this.arrow(new Vector3(), end, 0.004 * this.size, colour));
    }
    for (const part of [this.skin, this.net, this.restNet]) part.frustumCulled = false;
    this.scene.add(this.skin, this.net, this.restNet, this.markers, this.forces, this.cables,
                   this.axes);
  }

  arrow(from, to, radius, colour) {
    const along = to.clone().sub(from);
    const length = along.length();
    const head = Math.min(0.4 * length, 5 * radius);
    const paint = new MeshLambertMaterial({color: colour});
    const shaft = new Mesh(new CylinderGeometry(radius, radius, length - head, 16), paint);
    shaft.position.y = (length - head) / 2;
    const tip = new Mesh(new ConeGeometry(2.4 * radius, head, 20), paint);
    tip.position.y = length - head / 2;
    const made = new Group().add(shaft, tip);
    made.position.copy(from);
    made.quaternion.setFromUnitVectors(UP, along.normalize());
    return made;
  }

  standBack() {
    const half = Math.tan(this.camera.fov * Math.PI / 360);
    this.camera.position.set(0.55, -1, 0.42).normalize().multiplyScalar(0.46 * this.size / half)
        .add(this.centre);
    this.controls.update();
  }

  // Colours that follow the page's.
  paint() {
    const style = getComputedStyle(document.documentElement);
    const of = (name) => style.getPropertyValue(name).trim();
    this.scene.background = new Color(of('--paper'));
    this.restNet.material.color.set(of('--soft'));
    this.statusColours = ['--seen', '--one', '--hidden', '--rejected'].map((name) => of(name));
    this.forceColour = of('--hue1');
    this.cableColour = of('--hue0');
    if (this.controls) this.show(this.shown);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  show(i) {
    this.shown = i;
    const view = this.views[i];
    this.deform(view);
    for (const group of [this.markers, this.forces, this.cables]) {
      group.traverse((part) => {
        part.geometry?.dispose();
        part.material?.dispose();
      });
      group.clear();
    }
    this.addMarkers(view);
    this.addForces(view);
    this.addCables(view);
    this.slider.value = i;
    this.moment.textContent = `frame ${view.frame}, ${view.time.toFixed(3)} s` +
      (view.label ? `: ${view.label}` : '');
    this.place.dataset.frame = view.frame;
    this.render();
  }

  deform(view) {
    const stops = VIRIDIS.map((stop) => new Color(stop));
    const colour = new Color();
    const {array: x} = this.position;
    const stretch = this.factor * this.data.step;
    for (let i = 0; i < x.length; i += 3) {
      for (let k = 0; k < 3; ++k) x[i + k] = this.rest[i + k] + stretch * view.u[i + k];
      const length = Math.hypot(view.u[i], view.u[i + 1], view.u[i + 2]) * this.data.step;
      const share = Math.min(length / this.scale, 1) * (stops.length - 1);
      const stop = Math.min(Math.floor(share), stops.length - 2);
      colour.lerpColors(stops[stop], stops[stop + 1], share - stop).toArray(this.colour.array, i);
    }
    this.position.needsUpdate = this.colour.needsUpdate = true;
    this.skin.geometry.computeVertexNormals();
  }

  // Where a place of the true body stands when displacements are magnified: moved as the nearest
  // node is.
  magnified(p) {
    const n = this.nearestNode(p);
    const u = this.views[this.shown].u;
    const more = (this.factor - 1) * this.data.step;
    return new Vector3(p.x + more * u[n], p.y + more * u[n + 1], p.z + more * u[n + 2]);
  }

  // The same, off the surface by a marker's radius, so that its rim is seen all around.
  lifted(p) {
    const normal = new Vector3().fromBufferAttribute(
        this.skin.geometry.getAttribute('normal'), this.nearestNode(p) / 3);
    return this.magnified(p).addScaledVector(normal, 0.0085 * this.size);
  }

  nearestNode(p) {
    const u = this.views[this.shown].u;
    let best = 0;
    let least = Infinity;
    for (let i = 0; i < this.rest.length; i += 3) {
      const square = (this.rest[i] + this.data.step * u[i] - p.x) ** 2 +
        (this.rest[i + 1] + this.data.step * u[i + 1] - p.y) ** 2 +
        (this.rest[i + 2] + this.data.step * u[i + 2] - p.z) ** 2;
      if (square < least) {
        least = square;
        best = i;
      }
    }
    return best;
  }

  addMarkers(view) {
    for (let status = 0; status < this.data.statuses.length; ++status) {
      const those = view.markers.filter((marker) => marker[1] === status);
      if (those.length === 0) continue;
      // A ball with a rim of white and one of black, to stand out from any colour of the body.
      for (const [radius, paint] of [
        [0.0085, new MeshLambertMaterial({color: this.statusColours[status]})],
        [0.0115, new MeshBasicMaterial({color: 0xffffff, side: BackSide})],
        [0.0127, new MeshBasicMaterial({color: 0x000000, side: BackSide})],
      ]) {
        const balls = new InstancedMesh(
            new SphereGeometry(radius * this.size, 16, 12), paint, those.length);
        those.forEach(([, , x, y, z], k) => {
          const p = this.lifted(new Vector3(x, y, z));
          balls.setMatrixAt(k, new Matrix4().makeTranslation(p.x, p.y, p.z));
        });
        balls.frustumCulled = false;
        this.markers.add(balls);
      }
    }
  }

  addForces(view) {
    this.names = [];
    const normal = this.skin.geometry.getAttribute('normal');
    for (const [name, px, py, pz, fx, fy, fz, sd] of view.forces) {
      const force = new Vector3(fx, fy, fz);
      const norm = force.length();
      const place = this.magnified(new Vector3(px, py, pz));
      const along = force.clone().multiplyScalar(this.metresPerNewton);
      if (along.length() < 0.01 * this.size) continue;
      // A push ends at the place, a pull starts there: the arrow stays outside the body.
      const outward = new Vector3().fromBufferAttribute(
          normal, this.nearestNode(new Vector3(px, py, pz)) / 3);
      const push = outward.dot(force) < 0;
      const from = push ? place.clone().sub(along) : place;
      this.forces.add(this.arrow(from, from.clone().add(along), 0.008 * this.size,
                                 this.forceColour));
      this.names.push({
        at: push ? from : from.clone().add(along),
        text: `${name} ${norm.toPrecision(3)} N` +
          (sd === null ? '' : ` \u00b1 ${(1.96 * sd).toPrecision(2)}`),
      });
    }
  }

  addCables(view) {
    for (const cable of view.cables) {
      const geometry = new BufferGeometry().setFromPoints(cable.map((p) => new Vector3(...p)));
      this.cables.add(new Line(geometry, new LineBasicMaterial({color: this.cableColour})));
    }
  }

  render() {
    this.renderer.render(this.scene, this.camera);
    const {clientWidth: width, clientHeight: height} = this.canvas;
    const texts = this.forces.visible ? [...this.names ?? []] : [];
    if (this.axes.visible) {
      AXES.forEach(([text], k) => texts.push(
          {text, at: new Vector3().setComponent(k, 0.135 * this.size)}));
    }
    this.labels.replaceChildren(...texts.map(({at, text}) => {
      const p = at.clone().project(this.camera);
      const label = element('span', {textContent: text});
      label.style.left = `${(0.5 + p.x / 2) * width}px`;
      label.style.top = `${(0.5 - p.y / 2) * height}px`;
      return label;
    }));
  }

  ramp() {
    const strip = element('i');
    strip.style.background = `linear-gradient(to top, ${VIRIDIS.join(', ')})`;
    const text = (value) => element('span', {textContent: `${Number((1e3 * value).toPrecision(3))} mm`});
    return element('div', {className: 'ramp'}, strip,
                   element('div', {}, text(this.scale), text(this.scale / 2), text(0)));
  }

  toggle(name, parts, on) {
    const box = element('input', {type: 'checkbox', checked: on});
    box.addEventListener('change', () => {
      for (const part of parts) this[part].visible = box.checked;
      this.render();
    });
    return element('label', {}, box, name);
  }

  tools() {
    const last = this.views.length - 1;
    this.slider = element('input', {type: 'range', min: 0, max: last, step: 1, className: 'time'});
    this.slider.setAttribute('aria-label', 'Frame');
    this.slider.addEventListener('input', () => this.show(Number(this.slider.value)));
    this.moment = element('span', {className: 'moment'});
    const play = element('button', {type: 'button', textContent: 'Play', className: 'play'});
    play.addEventListener('click', () => this.play(play));
    const factor = element('select', {className: 'factor'});
    for (const times of [1, 2, 5, 10]) {
      factor.append(element('option', {value: times, textContent: `\u00d7 ${times}`}));
    }
    factor.addEventListener('change', () => {
      this.factor = Number(factor.value);
      this.show(this.shown);
    });
    const home = element('button', {type: 'button', textContent: 'Reset view'});
    home.addEventListener('click', () => {
      this.controls.target.copy(this.centre);
      this.standBack();
    });
    const frames = this.views.flatMap((view, i) => {
      if (!view.label) return [];
      const button = element('button', {type: 'button', textContent: view.label});
      button.addEventListener('click', () => this.show(i));
      return [button];
    });
    const tools = [
      element('div', {className: 'tools'}, play, this.slider, this.moment),
      element('div', {className: 'tools'}, ...frames),
      element('div', {className: 'tools'},
              element('label', {}, 'displacement', factor), this.toggle('net', ['net'], true),
              this.toggle('at rest', ['restNet'], false),
              this.toggle('markers', ['markers'], true), this.toggle('forces', ['forces'], true),
              this.toggle('axes', ['axes'], true), home),
    ];
    return element('div', {}, ...tools);
  }

  play(button) {
    if (this.timer) {
      clearInterval(this.timer);
      this.timer = 0;
    } else {
      this.timer = setInterval(
          () => this.show((this.shown + 1) % this.views.length), 1000 / FRAMES_PER_SECOND);
    }
    button.textContent = this.timer ? 'Pause' : 'Play';
  }
}
