import numpy as np
import pygltflib as gltf
import pytest

from onbeat.errors import FormatError
from onbeat.formats import Convention, write_motion
from onbeat.formats.body_mesh import body_mesh
from onbeat.formats.glb import glb_bytes
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from persons import person, swinging

_KINDS = {gltf.FLOAT: np.float32, gltf.UNSIGNED_SHORT: np.uint16, gltf.UNSIGNED_INT: np.uint32}
_WIDTH = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def loaded(motion: Motion) -> gltf.GLTF2:
    return gltf.GLTF2().load_from_bytes(glb_bytes(motion))


def values(file: gltf.GLTF2, accessor: int) -> np.ndarray:
    a = file.accessors[accessor]
    start = file.bufferViews[a.bufferView].byteOffset + (a.byteOffset or 0)
    width = _WIDTH[a.type]
    flat = np.frombuffer(file.binary_blob(), _KINDS[a.componentType], a.count * width, start)
    return flat.reshape(a.count, width)


def posed(file: gltf.GLTF2, frame: int) -> np.ndarray:
    """World positions (nodes, 3) of one frame, put together from nodes and channels as a viewer does."""
    nodes = file.nodes
    turns = [np.array([1.0, 0, 0, 0])] * len(nodes)
    moves = [np.array(node.translation or [0.0, 0, 0]) for node in nodes]
    for channel in file.animations[0].channels:
        value = values(file, file.animations[0].samplers[channel.sampler].output)[frame].astype(float)
        if channel.target.path == "rotation":
            turns[channel.target.node] = value[[3, 0, 1, 2]]
        else:
            moves[channel.target.node] = value
    places = np.zeros((len(nodes), 3))

    def walk(node: int, turn: np.ndarray, place: np.ndarray) -> None:
        places[node] = place + rot.rotate(turn, moves[node])
        for child in nodes[node].children or []:
            walk(child, rot.multiply(turn, turns[node]), places[node])

    walk(0, np.array([1.0, 0, 0, 0]), np.zeros(3))
    return places


def test_a_viewer_sees_the_same_joints_with_y_up():
    body = swinging(person(), frames=20)
    file = loaded(body)
    for frame in (0, 7, 19):
        x, y, z = body.positions[frame].T
        np.testing.assert_allclose(posed(file, frame)[: len(body.skeleton)], np.stack((x, z, -y), 1), atol=1e-5)


def test_animated_offsets_travel():
    body = swinging(person(), frames=5)
    offsets = np.tile(body.skeleton.offsets, (5, 1, 1))
    offsets[:, 1, 2] += np.linspace(0, 0.2, 5)
    moving = Motion(body.skeleton, body.rotations, body.root_positions, 30, "", offsets)
    x, y, z = moving.positions[4].T
    np.testing.assert_allclose(posed(loaded(moving), 4)[: len(x)], np.stack((x, z, -y), 1), atol=1e-5)


def test_times_run_from_zero_to_the_last_frame():
    body = swinging(person(), frames=31, fps=30)
    file = loaded(body)
    accessor = file.accessors[file.animations[0].samplers[0].input]
    assert (accessor.min, accessor.max) == ([0.0], [1.0])
    assert accessor.count == 31


def test_rotations_are_unit_and_continuous():
    file = loaded(swinging(person(), frames=90, angle=3.0))
    for channel in file.animations[0].channels:
        if channel.target.path == "rotation":
            turned = values(file, file.animations[0].samplers[channel.sampler].output).astype(float)
            np.testing.assert_allclose(np.linalg.norm(turned, axis=1), 1, atol=1e-6)
            assert (np.sum(turned[1:] * turned[:-1], axis=1) > 0).all()


def test_the_body_stands_on_the_ground_at_its_height():
    body = swinging(person())
    file = loaded(body)
    primitive = file.meshes[0].primitives[0]
    points = values(file, primitive.attributes.POSITION)
    accessor = file.accessors[primitive.attributes.POSITION]
    np.testing.assert_allclose(accessor.min, points.min(0))
    np.testing.assert_allclose(accessor.max, points.max(0))
    assert np.ptp(points[:, 1]) == pytest.approx(1.78, abs=0.05)
    assert points[:, 1].min() == pytest.approx(0.0, abs=0.05)
    assert values(file, primitive.attributes.JOINTS_0)[:, 1:].max() == 0
    bind = values(file, file.skins[0].inverseBindMatrices).reshape(-1, 4, 4)
    assert len(bind) == len(file.skins[0].joints) == len(body.skeleton)


def test_the_mesh_is_closed_and_faces_outwards():
    mesh = body_mesh(person())
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    outward = np.sum(np.cross(b - a, c - a) * mesh.normals[mesh.triangles].mean(1), axis=1)
    assert (outward > 0).all()
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1)


def test_any_skeleton_has_a_mesh(tmp_path):
    for skeleton in (Skeleton(["a"], [-1], [[0, 0, 0]]), Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0.1, 0, 0]])):
        write_motion(swinging(skeleton, frames=1), tmp_path / "a.glb")
        assert (tmp_path / "a.glb").read_bytes()[:4] == b"glTF"


def test_the_same_motion_gives_the_same_bytes():
    assert glb_bytes(swinging(person())) == glb_bytes(swinging(person()))


def test_other_conventions_are_refused(tmp_path):
    with pytest.raises(FormatError, match="always in metres with Y up"):
        write_motion(swinging(person()), tmp_path / "a.glb", Convention("z", "m"))


@pytest.mark.filterwarnings("error")
def test_what_no_32_bit_number_holds_is_refused():
    far = swinging(person()).replace(root_positions=np.full((60, 3), 1e39))
    with pytest.raises(FormatError, match=r"lengths that no \.glb file can hold"):
        glb_bytes(far)
    with pytest.raises(FormatError, match=r"times of frames that no \.glb file can hold"):
        glb_bytes(swinging(person()).replace(fps=1e-300))
    with pytest.raises(FormatError, match="too close for the times"):
        glb_bytes(swinging(person()).replace(fps=1e300))


def test_more_joints_than_16_bits_count_are_refused():
    count = 2**16 + 1
    skeleton = Skeleton([str(n) for n in range(count)], [-1, *[0] * (count - 1)], np.zeros((count, 3)))
    with pytest.raises(FormatError, match="up to 65536 joints, the motion has 65537"):
        glb_bytes(swinging(skeleton, frames=1))


def test_bones_that_are_one_are_drawn_once():
    one = Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 0, 1.0]])
    twins = Skeleton(["a", "b", "c"], [-1, 0, 0], [[0, 0, 0], [0, 0, 1.0], [0, 0, 1.0]])
    forked = Skeleton(["a", "b", "c"], [-1, 0, 0], [[0, 0, 0], [0, 0, 1.0], [0, 1.0, 0]])
    assert len(body_mesh(twins).vertices) == len(body_mesh(one).vertices) < len(body_mesh(forked).vertices)


def test_a_head_and_hands_are_drawn_where_a_file_ends_with_their_joints():
    whole = person()
    ends = {"Head_end", "LeftWrist_end", "RightWrist_end"}
    kept = [joint for joint, name in enumerate(whole.names) if name not in ends]
    parents = [kept.index(p) if p >= 0 else -1 for p in whole.parents[kept].tolist()]
    short = Skeleton([whole.names[j] for j in kept], parents, whole.offsets[kept], whole.end_sites[kept])
    for skeleton in (whole, short):
        mesh = body_mesh(skeleton)
        head = mesh.vertices[mesh.joints == skeleton.index("Head")]
        assert np.ptp(head[:, 2]) == pytest.approx(0.24, abs=0.04)
        assert np.ptp(mesh.vertices[:, 2]) == pytest.approx(1.78, abs=0.1)
        for side in ("Left", "Right"):
            assert np.ptp(mesh.vertices[mesh.joints == skeleton.index(f"{side}Wrist"), 0]) > 0.12
