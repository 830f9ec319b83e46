"""Graphs in Lua for the lightings that the panel offers. Knows nothing of Blender."""

operators = {
    "path": """direct = DirectLighting {{{groups}}}
bounce = PathTracing {{{groups}}}
light = Combine {{ direct, bounce }}""",
    "direct": "direct = DirectLighting {{{groups}}}\nlight = Combine {{ direct }}",
    "ao": "light = AmbientOcclusion {{}}",
    "guided": """guide = Guide {{ paths = {learning}, when = "worthwhile" }}
light = PathTracing {{ paths = "all", guide = guide{and_groups} }}""",
    "progressive": """direct = DirectLighting {{}}
indirect = ProgressivePhotonMapping {{ paths = "indirect", photons = 100000 }}
light = Combine {{ direct, indirect }}""",
    "figure5": """direct = DirectLighting {{}}
caustics = PhotonMap {{ paths = "caustic", photons = 0, error = 0.04, gather = 50 }}
global = PhotonMap {{ paths = "diffuse", photons = 0, error = 0.04, gather = 50 }}
first = Combine {{ direct, caustics, global }}
soft = IrradianceCache {{ first, rays = 0, glossy_rays = 4, error = 0.04 }}
light = Combine {{ direct, caustics, soft }}""",
}
by_groups = {"path", "direct", "guided"}
facts = {"Depth": "depth", "Normal": "normal", "Position": "position", "UV": "uv", "DiffCol": "albedo", "Vector": "motion"}
mattes = {"CryptoObject": "object", "CryptoMaterial": "material"}


def text_of(lighting, size, samples, noise=0, groups=None, shown=(), ranks=6, transparent=False, clean=False, later=None):
    """A graph of `scene.xml` beside it. groups: names of lamps by group; shown: names of passes;
    later: the file of the scene one frame later, which Vector needs."""
    groups = groups if lighting in by_groups else None
    learning = max(60000, size[0] * size[1] * samples // 24)  # as graphs/guided.lua
    lines = ['scene = Scene { "scene.xml"' + beside(later) + (f", groups = {table(groups)}" if groups else "") + " }"]
    on = "groups = true" if groups else ""
    lines.append(operators[lighting].format(groups=on, and_groups=f", {on}" if on else "", learning=learning))
    names = []
    for name in shown:
        if name in facts:
            lines.append(f'{name} = SurfaceFact {{ of = "{facts[name]}" }}')
            names.append(name)
        elif name in mattes:
            lines.append(f'{name} = Cryptomatte {{ of = "{mattes[name]}", ranks = {ranks} }}')
            names.append(name)
    more = [f"samples = {samples}"] + ([f"error = {noise!r}"] if noise > 0 else []) + ([on] if on else [])
    more += [f"show = {{ {', '.join(names)} }}"] if names else []
    more += ["alpha = true", "background = false"] if transparent else []
    film = f'film = {{ {size[0]}, {size[1]}, file = "picture.exr"{", clean = true" if clean else ""} }}'
    lines.append(f"image = RayTracer {{ light, scene = scene, {', '.join(more)}, {film} }}")
    return "\n".join(lines) + "\n"


def backwards_of(size, samples, earlier):
    """A graph of `scene.xml` that tells how far things on the picture are from where they were in another file."""
    return f"""scene = Scene {{ "scene.xml"{beside(earlier)} }}
light = DirectLighting {{}}
Vector = SurfaceFact {{ of = "motion" }}
image = RayTracer {{ light, scene = scene, samples = {samples}, show = {{ Vector }}, film = {{ {size[0]}, {size[1]}, file = "back.exr" }} }}
"""


def beside(file):
    """What a scene says of the file with the next frame."""
    return f', next = {{ file = "{file}", time = 0 }}' if file else ""


def table(groups):
    entries = (f"{name} = {{ {', '.join(quoted(lamp) for lamp in lamps)} }}" for name, lamps in sorted(groups.items()))
    return "{ " + ", ".join(entries) + " }"


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
