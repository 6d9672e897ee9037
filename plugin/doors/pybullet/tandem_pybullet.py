"""Remote dynamic proxies for PyBullet: distant users push the same body.

    import pybullet as p, tandem_pybullet as tandem

    with tandem.Site(device=tandem.SimulatedDevice(start=(-0.03, 0, 0))) as site:
        site.share(cube)                                   # a PyBullet body, the same at each user
        site.obstacle(floor)                               # the hand and the cube can touch it
        site.connect(2, site.mesh(1, "0.0.0.0:7001", [tandem.Peer(2, "host:7001", "pair.key")])[2],
                     start=(0.03, 0, 0))
        while True:
            site.push((5, 0, 0))                           # the hand
            site.step()                                    # p.stepSimulation()
            print(site.force(), site.read().objects[0].position)

Needs pybullet and the plugin libtandem-pybullet.so. The plugin is beside this file, in a
lib/.../tandem folder above it, or named by the environment variable TANDEM_PYBULLET_PLUGIN. SI units;
quaternions are x, y, z, w. A refused call raises TandemError with one line of text. All calls for
one physics client belong to one thread.
"""

import glob
import os
import warnings
from array import array
from collections import namedtuple

import pybullet

__all__ = ["Device", "Grip", "Hold", "Link", "LINK_STATES", "Packet", "Peer", "PeerStatus",
           "PHASES", "Reading", "SimulatedDevice", "Site", "State", "STATUS_BITS", "TandemError", "create_key",
           "find_plugin"]

_POSTFIX = "_tandem"
_WORDS_PER_COMMAND = 128
_MULTIBODY = 2  # body type
_MOST_POINTS = 4096  # of a hull
_CLOSED, _NO_MEMORY, _BAD_COMMAND, _WRONG_ORDER = -1, -6, -10, -11

#: Pose of a centre of mass and its velocities, each a tuple.
State = namedtuple("State", "position orientation velocity angular_velocity")

#: State of a site at one moment. `force`: on the hand [N]; `hip`: position of the hand [m]; `status`:
#: names of STATUS_BITS. `proxies` and `links` have an entry per remote; links are names of LINK_STATES,
#: or of PHASES while a mesh's peer is not live.
Reading = namedtuple("Reading", "force hip hip_velocity ticks status state_hash packets_sent "
                                "packets_taken has_ended objects proxies links")

#: A state that manual links carry between sites; `objects`: (id, State, epoch) each, an epoch being its
#: number and its author; both are 0 until a site puts the object elsewhere. The energies [J] are the sender's
#: part of its ledger with the receiver; NaN: it keeps no account. `grip`: a Hold, or None before the
#: sender's user has held anything. `roll`: (heard, members, age), sets of sites as bits, bit i for id
#: i + 1, and the age of the sender's site [s], or None while the number of sites is fixed.
Packet = namedtuple("Packet", "sender is_idle sequence time position velocity energy_granted "
                              "energy_holdings objects grip roll", defaults=(None, None))

#: What a packet's sender holds. `epoch` counts grabs and releases; `object` is None while nothing is held;
#: `position` and `orientation` of the hand in the object's frame; `age` of the last change [s].
Hold = namedtuple("Hold", "epoch object position orientation age")

#: What the hand holds. `at`: place on the object in its frame [m]; `force` on the object [N], the hand gets
#: the opposite; `torque` on the object besides [N m].
Grip = namedtuple("Grip", "object is_fading at force torque")

#: A remote of a mesh. `address`: "host:port", or None if the peer calls us, which needs a lower number
#: than ours. `key`: a file.
Peer = namedtuple("Peer", "id address key")

PeerStatus = namedtuple("PeerStatus", "phase silence round_trip loss")

LINK_STATES = ("waiting", "live", "stale", "fading", "lost", "rejoining")
PHASES = ("calling", "agreeing", "different", "live", "left")
STATUS_BITS = ("device_invalid", "body_missing", "packet_refused", "host_step_wrong",
               "state_not_finite", "world_gone", "out_of_range")


class TandemError(RuntimeError):
    """A refused command; `status` is the plugin's error number."""

    def __init__(self, status, text):
        super().__init__(text)
        self.status = status


class Device:
    """A hand that the script moves: Site.move(). `max_force` [N] and `max_slew` [N/s] limit the force
    on it."""

    def __init__(self, start=(0, 0, 0), max_force=None, max_slew=None):
        self.words = {"kind": "moved", "start": start, "max_force": max_force, "max_slew": max_slew}


class SimulatedDevice:
    """A handle of `mass` [kg] and `damping` [N s/m] that a hand pushes: Site.push(). `guide`: unit
    vector of a slot that limits its motion."""

    def __init__(self, start=(0, 0, 0), mass=0.1, damping=0.5, guide=None):
        self.words = {"kind": "simulated", "start": start, "mass": mass, "damping": damping,
                      "guide": guide}


class Link:
    """A link to one remote, made by a Site. push() and pop() are for manual links."""

    def __init__(self, site, number):
        self._site = site
        self.number = number

    def push(self, packet):
        """Delivers a received Packet for the next step."""
        numbers = [packet.sender, packet.is_idle, packet.sequence, packet.time, *packet.position,
                   *packet.velocity, packet.energy_granted, packet.energy_holdings,
                   len(packet.objects)]
        for number, state, epoch in packet.objects:
            numbers.append(number)
            for part in state:
                numbers.extend(part)
            numbers.extend(epoch)
        if packet.grip is not None:
            epoch, number, position, orientation, age = packet.grip
            numbers += [epoch, -1 if number is None else number, *position, *orientation, age]
        if packet.roll is not None:
            heard, members, age = packet.roll
            for sites in (heard, members):
                numbers += [sites & 0xffffffff, sites >> 32]
            numbers.append(age)
        self._site._send_doubles("push", numbers, link=self.number)

    def pop(self):
        """Takes the next Packet to send, or None."""
        numbers = self._site._ask("pop", link=self.number)
        if not numbers:
            return None
        sender, is_idle, sequence, time = numbers[:4]
        objects, grip, roll, end = [], None, None, 13 + 16 * int(numbers[12])
        if len(numbers) - end in (5, 15):
            low, high, low_members, high_members = (int(half) for half in numbers[-5:-1])
            roll = (low | high << 32, low_members | high_members << 32, numbers[-1])
        if len(numbers) - end >= 10:
            epoch, number = int(numbers[end]), int(numbers[end + 1])
            grip = Hold(epoch, None if number < 0 else number, tuple(numbers[end + 2:end + 5]),
                        tuple(numbers[end + 5:end + 9]), numbers[end + 9])
        for at in range(13, end, 16):
            epoch = (int(numbers[at + 14]), int(numbers[at + 15]))
            objects.append((int(numbers[at]), _state_of(numbers[at + 1:at + 14]), epoch))
        return Packet(int(sender), bool(is_idle), int(sequence), time, tuple(numbers[4:7]),
                      tuple(numbers[7:10]), numbers[10], numbers[11], objects, grip, roll)


class Site:
    """One user's site in one physics client.

    `device`: a Device or SimulatedDevice. `self_id`: this user's number, 1 or more. `peers`: number of
    users; each copy of a body carries 1/peers of its mass. `settings`: haptic_rate, packet_rate,
    contact=(K, B), coordination=(K, B), coordination_mode="sum" or "average", proxy_mass, proxy_damping,
    proxy_radius, hip_radius, scheme, guide=(x, y, z) and more: docs/pybullet.md. The defaults are those of the paper's Experiment I.
    A client takes one site at a time.
    """

    def __init__(self, device=None, self_id=1, peers=2, client=0, plugin=None, **settings):
        self._client = client
        self._spheres = []  # (body, its info)
        self._obstacles = set()
        self._radius = settings.get("proxy_radius")
        self._plugin = _load(client, plugin)
        self._command("device", **(device or Device()).words)
        try:
            self._command("site", self=self_id, peers=peers, **settings)
        except Exception:
            self._command("close")  # otherwise the next site would get this device
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    @property
    def client(self):
        """Number of the physics client."""
        return self._client

    # Set-up.

    def share(self, body, damping=0.0, shape=None, object=None):
        """Shares a body without joints and returns its number, from 0. All users share the same bodies
        in the same order. `damping` acts on this copy [N s/m]. Give `shape` if PyBullet does not
        know it (maximal coordinates): ("box", half_extents), ("sphere", radius),
        ("capsule", radius, height), ("cylinder", radius, height) or ("hull", points).
        `object`: the number of an object without a body, after unshare() or because its body was
        removed; it keeps its damping."""
        if object is not None:
            return self._command_with_shape("share", body, shape, object=object)
        return self._command_with_shape("share", body, shape, damping=damping)

    def share_all(self, bodies, damping=0.0):
        """Shares bodies by name: {"cube": body, "ball": other}. Returns {name: number of the object}.
        Numbers follow the order of the names, so users who share the same names pair the same
        objects, whatever the order of theirs. Comes before share(); give the names to mesh()."""
        return {name: self.share(bodies[name], damping) for name in sorted(bodies)}

    def share_tool(self, body, user, at=(0, 0, 0), shape=None):
        """Gives a user (self_id or a peer) a body without joints as a tool and returns its number, from
        0. The user's hand holds it at once by its place `at`, from the centre of mass in its frame [m];
        at the peers the user's proxy does. It touches things with friction, in the hand's place, and
        turns with the orientation of move(). All users share bodies and tools in the same order."""
        return self._command_with_shape("share", body, shape, tool_of=user, at=at)

    def unshare(self, object):
        """Gives a shared object back to PyBullet, with its own mass and its velocity. The others stay
        shared; share(body, object=...) shares a body for it again. Between any two steps."""
        self._command("unshare", object=object)

    def grab(self, object, at=None):
        """Lets the hand hold a shared object by its place `at`, from the centre of mass in the object's
        frame [m]; None: where the hand is. Its weight passes to the hand. Between any two steps."""
        self._command("grab", object=object, **({} if at is None else {"at": at}))

    def release(self):
        """Lets go of what the hand holds; the force fades within 50 ms."""
        self._command("release")

    def grip(self):
        """What the hand holds, as a Grip, or None."""
        numbers = self._ask("grip")
        if not numbers:
            return None
        return Grip(int(numbers[0]), bool(numbers[1]), *(tuple(numbers[i:i + 3]) for i in (2, 5, 8)))

    def obstacle(self, body, shape=None):
        """Makes a static body an obstacle: shared bodies, proxies and the hand touch it in Tandem, and
        no longer in PyBullet. `shape` as in share(), or ("plane",) for all below z = 0 of the
        body."""
        self._command_with_shape("obstacle", body, shape)
        self._obstacles.add(body)

    def obstacles(self):
        """Makes obstacles of all other static bodies without joints; returns their numbers.
        Skips bodies without collision shape. Skips unsuitable bodies with a warning that names the
        reason."""
        found = []
        for index in range(pybullet.getNumBodies(physicsClientId=self._client)):
            body = pybullet.getBodyUniqueId(index, physicsClientId=self._client)
            mass = pybullet.getDynamicsInfo(body, -1, physicsClientId=self._client)[0]
            joints = pybullet.getNumJoints(body, physicsClientId=self._client)
            if mass != 0 or joints != 0 or body in self._obstacles or not self._collides(body):
                continue
            try:
                self.obstacle(body)
                found.append(body)
            except TandemError as why:
                if why.status == _WRONG_ORDER or self._plugin < 0:  # the site is the cause
                    raise
                warnings.warn(f"no obstacle: {why}", stacklevel=2)
        return found

    def connect(self, peer, link, start=(0, 0, 0), show=(0.2, 0.6, 0.9, 0.7)):
        """Connects the remote user `peer`, whose hand starts at `start`; returns the remote's number,
        from 0. `show`: colour of a sphere that shows its proxy and pushes other bodies in PyBullet's
        world, or None."""
        remote = self._command("connect", peer=peer, link=link.number, start=start)
        proxy = self.read().proxies[remote].position
        if show is not None and proxy[0] == proxy[0]:  # NaN: a scheme without proxies
            self._show(remote, proxy, show)
        return remote

    def simulated_link(self, name, delay=0.0, jitter=0.0, loss=0.0, duplicate=0.0, reorder=0.0,
                       seed=1):
        """One end of the simulated link `name` between two clients of this process. The other user
        calls this with the same arguments. `delay` and `jitter` are in seconds; `loss`, `duplicate`
        and `reorder` are probabilities."""
        return Link(self, self._command("link", kind="simulated", name=name, delay=delay,
                                        jitter=jitter, loss=loss, duplicate=duplicate,
                                        reorder=reorder, seed=seed))

    def manual_link(self):
        """A link that the script carries: send what Link.pop() returns, Link.push() what arrives."""
        return Link(self, self._command("link", kind="manual"))

    def mesh(self, self_id, bind, peers, agreements=None, objects=()):
        """Sealed UDP links to all `peers` over one socket bound to `bind`, "0.0.0.0:7001". Returns
        {peer's id: Link}. `agreements`: {key: value} that must be equal at all sites, and so must the
        names `objects`, of share_all(). Step in real time."""
        # Make all lines first: an invalid one must not leave the others waiting in the plugin.
        lines = [_line("peer", {"id": peer.id, "key": peer.key, "address": peer.address})
                 for peer in peers]
        lines += [_line("agree", {"key": key, "value": value})
                  for key, value in [*(agreements or {}).items(),
                                     *((f"object.{name}", "shared") for name in objects)]]
        for line in lines:
            self._check(self._send(line))
        self._command("mesh", self=self_id, bind=bind)
        return {peer.id: Link(self, self._command("link", kind="mesh", peer=peer.id))
                for peer in peers}

    # In the loop.

    def push(self, force):
        """Sets the force of a simulated device's hand from now on [N]."""
        self._command("hand", force=force)

    def move(self, position, velocity=(0, 0, 0), orientation=None, angular_velocity=(0, 0, 0)):
        """Sets the position [m] and velocity [m/s] of the hand; with an orientation (x, y, z, w) also its
        wrist, which turns what it holds. Its angular velocity is in W [rad/s]."""
        turn = {} if orientation is None else {"orientation": orientation, "angular_velocity": angular_velocity}
        self._command("hand", position=position, velocity=velocity, **turn)

    def step(self):
        """Calls p.stepSimulation(), which also runs the haptic ticks of this time."""
        pybullet.stepSimulation(physicsClientId=self._client)

    def force(self):
        """Force on the hand that was rendered last [N]; zero after the site has ended."""
        return tuple(self._ask("force"))

    def read(self):
        """Reads the whole state as a Reading."""
        numbers = self._ask("read")
        objects, remotes = int(numbers[16]), int(numbers[17])
        states = [_state_of(numbers[at:at + 13])
                  for at in range(18, 18 + 13 * (objects + remotes), 13)]
        links = numbers[18 + 13 * (objects + remotes):]
        bits = int(numbers[10])
        return Reading(tuple(numbers[0:3]), tuple(numbers[3:6]), tuple(numbers[6:9]),
                       int(numbers[9]),
                       tuple(name for i, name in enumerate(STATUS_BITS) if bits >> i & 1),
                       int(numbers[11]) << 32 | int(numbers[12]), int(numbers[13]),
                       int(numbers[14]), bool(numbers[15]), states[:objects], states[objects:],
                       tuple((LINK_STATES + PHASES)[int(state)] for state in links))

    def states(self):
        """States of the shared bodies in the haptic island."""
        return self.read().objects

    def contact_points(self, body_a=-1, body_b=-1):
        """Like p.getContactPoints(body_a, body_b), with the contacts that Tandem solves as well: between
        shared bodies, obstacles and proxies, which PyBullet does not see. Tuples are as PyBullet's,
        with link -1; the friction of Tandem's is in the first direction, as one force."""
        bodies = {key: body for key, body in (("bodyA", body_a), ("bodyB", body_b)) if body >= 0}
        points = list(pybullet.getContactPoints(physicsClientId=self._client, **bodies) or ())
        numbers = self._ask("contacts")
        for at in range(1, 1 + 16 * int(numbers[0]), 16):
            a, b = int(numbers[at]), int(numbers[at + 1])
            on_a, on_b, normal = (tuple(numbers[at + i:at + i + 3]) for i in (2, 5, 8))
            friction = numbers[at + 13:at + 16]
            if body_a not in (-1, a) or body_b not in (-1, b):
                if body_a not in (-1, b) or body_b not in (-1, a):
                    continue
                a, b, on_a, on_b = b, a, on_b, on_a
                normal = tuple(-x for x in normal)
                friction = [-x for x in friction]
            size = sum(x * x for x in friction) ** 0.5
            along = tuple(x / size for x in friction) if size > 0 else (0.0, 0.0, 0.0)
            points.append((0, a, b, -1, -1, on_a, on_b, normal, numbers[at + 11], numbers[at + 12],
                           size, along, 0.0, (0.0, 0.0, 0.0)))
        return tuple(points)

    def mesh_status(self, peer):
        """PeerStatus of a peer of the mesh; `phase` is one of PHASES, times in seconds."""
        phase, silence, round_trip, loss = self._ask("mesh_status", peer=peer)
        return PeerStatus(PHASES[int(phase)], silence, round_trip, loss)

    def mesh_explain(self, peer):
        """Known reasons why a peer of the mesh does not become live: lines of text."""
        answer = self._send(_line("mesh_explain", {"peer": peer}))
        self._check(answer)
        return answer[1].decode().splitlines()

    def warnings(self):
        """Facts about the attached bodies and events since: lines of text."""
        answer = self._send("warnings")
        self._check(answer)
        return answer[1].decode().splitlines()

    def close(self):
        """Restores PyBullet's bodies and ends the site. The plugin stays loaded."""
        if self._plugin < 0:
            return
        self._command("close")
        self._plugin = -1
        spheres, self._spheres = self._spheres, []
        for body, info in spheres:
            try:
                if info == pybullet.getBodyInfo(body, physicsClientId=self._client):
                    pybullet.removeBody(body, physicsClientId=self._client)
            except pybullet.error:
                pass  # the script has removed it

    # Private.

    def _show(self, remote, position, colour):
        radius = self._radius or 0.01
        client = {"physicsClientId": self._client}
        shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=radius, **client)
        visual = pybullet.createVisualShape(pybullet.GEOM_SPHERE, radius=radius, rgbaColor=colour,
                                            **client)
        body = pybullet.createMultiBody(1, shape, visual, basePosition=position, **client)
        try:
            self._command("proxy", remote=remote, body=body)
        except TandemError:
            pybullet.removeBody(body, **client)
            raise
        self._spheres.append((body, pybullet.getBodyInfo(body, **client)))

    def _command_with_shape(self, name, body, shape, /, **words):
        if shape is None:
            shape = self._hull_of(body)
        words["body"] = body
        if shape is None:
            return self._command(name, **words)
        kind, *size = shape
        words["shape"] = kind
        if kind == "hull":
            points = list(size[0])
            if len(points) > _MOST_POINTS:
                raise TandemError(_BAD_COMMAND,
                                  f"body {body}: a hull of {len(points)} points, and there may be "
                                  f"{_MOST_POINTS}: give shape=(\"hull\", points) with fewer")
            return self._send_doubles(name, [x for point in points for x in point], **words)
        if size:
            words["size"] = size[0] if kind == "box" else size
        return self._command(name, **words)

    def _collides(self, body):
        """True if the base has a collision shape."""
        client = {"physicsClientId": self._client}
        if pybullet.getDynamicsInfo(body, -1, **client)[10] == _MULTIBODY:
            return bool(pybullet.getCollisionShapeData(body, -1, **client))
        low, high = pybullet.getAABB(body, -1, **client)
        return low != high

    def _hull_of(self, body):
        """Points of a body that is one mesh, because the plugin cannot ask for them. None for other
        bodies, and if PyBullet does not tell the points."""
        client = {"physicsClientId": self._client}
        try:
            if pybullet.getDynamicsInfo(body, -1, **client)[10] != _MULTIBODY:
                return None  # PyBullet does not tell the shape of a btRigidBody
            pieces = pybullet.getCollisionShapeData(body, -1, **client)
            if len(pieces) != 1 or pieces[0][2] != pybullet.GEOM_MESH:
                return None
            points = pybullet.getMeshData(body, -1, **client)[1]
        except pybullet.error:
            return None
        return ("hull", sorted(set(points))) if points else None

    def _send_doubles(self, name, numbers, /, **words):
        """Runs a command with doubles. PyBullet carries them exactly only as pairs of 32-bit words."""
        ints = array("i", array("d", numbers).tobytes()).tolist()
        while len(ints) > _WORDS_PER_COMMAND:
            self._check(self._send("data", ints[:_WORDS_PER_COMMAND]))
            ints = ints[_WORDS_PER_COMMAND:]
        return self._check(self._send(_line(name, words), ints))

    def _command(self, name, /, **words):
        """Runs a command and returns its number."""
        return self._check(self._send(_line(name, words)))

    def _ask(self, name, /, **words):
        """Runs a command and returns its doubles."""
        answer = self._send(_line(name, words))
        self._check(answer)
        return array("d", answer[1])

    def _check(self, answer):
        return _check(answer)

    def _send(self, line, ints=()):
        return _execute(self._plugin, self._client, line, ints)


def create_key(path, client=0):
    """Makes a file with a new key for a pair of sites; both need it. Only its owner may read it."""
    _check(_execute(_load(client), client, _line("key", {"path": path})))


def find_plugin():
    """Path of libtandem-pybullet.so. Raises FileNotFoundError with the searched places."""
    named = os.environ.get("TANDEM_PYBULLET_PLUGIN")
    here = os.path.dirname(os.path.abspath(__file__))
    name = "libtandem-pybullet.so"
    places = [named] if named else [os.path.join(here, name)]
    if not named:
        for up in (".", "..", "../..", "../../.."):
            places += sorted(glob.glob(os.path.join(here, up, "lib", "tandem", name)) +
                             glob.glob(os.path.join(here, up, "lib", "*", "tandem", name)))
    for place in places:
        if os.path.isfile(place):
            return os.path.realpath(place)
    raise FileNotFoundError(f"{name}: not at {', '.join(places)}; set TANDEM_PYBULLET_PLUGIN")


def _load(client, plugin=None):
    number = pybullet.loadPlugin(plugin or find_plugin(), _POSTFIX, physicsClientId=client)
    if number < 0:
        raise TandemError(-1, "PyBullet could not load the plugin; it has said why on the terminal")
    return number


def _execute(plugin, client, line, ints=()):
    """Runs a command and returns its status and bytes. PyBullet gives bytes as signed numbers, or
    only the status if there are none."""
    answer = pybullet.executePluginCommand(plugin, line, ints, physicsClientId=client)
    if isinstance(answer, int):
        return answer, b""
    status, _, data = answer
    return status, array("b", data).tobytes()


def _check(answer):
    """Returns the status of an answer; raises if it was refused. Two errors have no text: PyBullet's
    if the plugin is gone, and the plugin's if memory is."""
    status, text = answer
    if status < 0:
        otherwise = {_CLOSED: "the site is closed", _NO_MEMORY: "no memory is left"}
        raise TandemError(status, text.decode() or
                          otherwise.get(status, f"refused, without a word why ({status})"))
    return status


def _state_of(numbers):
    return State(tuple(numbers[0:3]), tuple(numbers[3:7]), tuple(numbers[7:10]),
                 tuple(numbers[10:13]))


def _line(name, words):
    """Makes the text of a command; repr() keeps all digits of a float."""
    parts = [name]
    for key, value in words.items():
        if value is None:
            continue
        if isinstance(value, str):
            if '"' in value:
                raise ValueError(f"{key}={value}: no double quotes")
            parts.append(f'{key}="{value}"' if " " in value else f"{key}={value}")
        elif isinstance(value, bool):
            parts.append(f"{key}={int(value)}")
        elif isinstance(value, int):
            parts.append(f"{key}={value}")
        elif isinstance(value, float):
            parts.append(f"{key}={float(value)!r}")
        else:
            parts.append(key + "=" + ",".join(repr(float(x)) for x in value))
    line = " ".join(parts)
    if len(line) > 1023:
        raise ValueError(f"{name}: longer than the 1023 characters that PyBullet carries")
    return line
