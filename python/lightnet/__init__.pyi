"""Types of lightnet. Written by python/stubs.py."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal

from .errors import Error as Error, NoProgram as NoProgram, NoWorker as NoWorker, UnknownKey as UnknownKey
from .errors import UserError as UserError
from .graph import File as File, Node as Node, check as check, dot as dot, load as load
from .operators import Questions as Questions, operator as operator
from .picture import Picture as Picture, read as read
from .race import Race as Race, race as race
from .run import Run as Run, progress as progress, render as render
from .scenes import Lamp as Lamp, Mesh as Mesh, World as World
from .session import Session as Session

class AmbientOcclusion(Node):
    """ambient occlusion: how open the surroundings of a point are, 1 where nothing is near.

    samples: integer, in samples, default 16.0, 1.0 … 65536.0
        directions per question
    distance: number, in scene units, default 0.0, 0.0 …
        how far away a surface still counts; 0: any distance
    """

    def __init__(
        self,
        *inputs: Node,
        samples: int | None = ...,
        distance: float | None = ...,
        name: str | None = ...,
    ) -> None: ...

class CandelaDimmed(Node):
    """wrapped example: a part of its input, up to a limit.

    Inputs: 1 that give light.

    strength: number, default 1.0, 0.0 …
        the part
    limit: number, default 1000.0, 0.0 …
        the most radiance
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    """

    def __init__(
        self,
        *inputs: Node,
        strength: float | None = ...,
        limit: float | None = ...,
        lamps: str | Sequence[str] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class CandelaDirect(Node):
    """wrapped example: light straight from lamps, on matt surfaces.

    rays: integer, default 1.0, 1.0 … 65536.0
        points on lamps per question
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    """

    def __init__(
        self,
        *inputs: Node,
        rays: int | None = ...,
        lamps: str | Sequence[str] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class CandelaEye(Node):
    """wrapped example: follows one ray at a time, through mirrors.

    Inputs: 1 that give light.

    scene: scene
        what is found
    film: film
        width, height, and file of the image
    samples: integer, in samples, default 16.0, 1.0 … 16777216.0
        samples per pixel
    mirrors: integer, default 8.0, 1.0 … 65536.0
        in a row that are followed
    """

    def __init__(
        self,
        *inputs: Node,
        scene: Node | None = ...,
        film: Sequence[int] | Mapping[str, Any] | None = ...,
        samples: int | None = ...,
        mirrors: int | None = ...,
        name: str | None = ...,
    ) -> None: ...

class CandelaGathered(Node):
    """wrapped example: light that matt surroundings scatter once.

    Inputs: 1 that give light.

    rays: integer, default 16.0, 1.0 … 65536.0
        directions per question
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    """

    def __init__(
        self,
        *inputs: Node,
        rays: int | None = ...,
        lamps: str | Sequence[str] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class CandelaOpen(Node):
    """wrapped example: how open it is around a point.

    rays: integer, default 8.0, 1.0 … 65536.0
        directions per question
    near: number, default 100.0, 0.0 …
        what keeps light off, scene units
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    """

    def __init__(
        self,
        *inputs: Node,
        rays: int | None = ...,
        near: float | None = ...,
        lamps: str | Sequence[str] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Clamp(Node):
    """its input without fireflies: less noise, and a little too dark.

    Inputs: 1 that give light.

    most: number, in W·sr⁻¹·m⁻², default 10.0, 0.0 …
        of each answer, in its strongest colour
    """

    def __init__(
        self,
        *inputs: Node,
        most: float | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Combine(Node):
    """the sum of its inputs, each times its weight.

    Inputs: 1 that give light.

    weights: numbers, default []
        one per input; none: all 1
    """

    def __init__(
        self,
        *inputs: Node,
        weights: Sequence[float] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Cryptomatte(Node):
    """no light: which objects, materials or lamps each pixel shows, and how much of it they cover.

    of: text, "object" | "mesh" | "material" | "lamp"
        what is told apart, by the names that the scene's file gives
    ranks: integer, default 6.0, 2.0 … 32.0
        how many are told apart in one pixel: those that cover most of it
    """

    def __init__(
        self,
        *inputs: Node,
        of: Literal["object", "mesh", "material", "lamp"] | None = ...,
        ranks: int | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Custom(Node):
    """a function of the graph file: columns in, columns out.

    Inputs: 0 that give light.

    light: text
        function(q, ask) that answers with a column of numbers or colours
    """

    def __init__(
        self,
        *inputs: Node,
        light: str | None = ...,
        name: str | None = ...,
    ) -> None: ...

class DirectLighting(Node):
    """direct light: what comes straight from lamps and environment.

    samples: integer, in samples, default 1.0, 1.0 … 65536.0
        points on lamps, and directions drawn from the BSDF, per question; with an error: at least
    error: number, default 0.0, 0.0 … 1.0
        noise threshold: takes as many samples as bring the error of each answer, relative to it, to this, as sixteen trials tell; 0: takes the same number everywhere
    most_samples: integer, in samples, default 64.0, 1.0 … 65536.0
        with an error: at most, taken up to a power of two
    heuristic: text, "auto" | "power" | "balance" | "lamps" | "directions", default "auto"
        by which multiple importance sampling weights both ways to find a light; auto: by power for lamps, by balance for the sky and suns; or lamps, directions: what points on lamps, or directions from the BSDF, find alone, to see what each is good for
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        samples: int | None = ...,
        error: float | None = ...,
        most_samples: int | None = ...,
        heuristic: Literal["auto", "power", "balance", "lamps", "directions"] | None = ...,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Emission(Node):
    """emitted light: what surfaces shine by themselves; for nodes that gather light, as the renderer sees it anyhow.

    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Environment(Node):
    """direct light of the environment, without that of lamps; a part of DirectLighting.

    samples: integer, in samples, default 1.0, 1.0 … 65536.0
        directions per question
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        samples: int | None = ...,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class FinalGather(Node):
    """final gathering: light by one more bounce, off surfaces that its input tells the brightness of.

    Inputs: 1 that give light.

    rays: integer, in rays, default 1.0, 1.0 … 65536.0
        directions per question
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        rays: int | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Guide(Node):
    """no light: learns where light comes from, for path tracing that takes it as its guide.

    paths: integer, in paths, default 150000.0, 64.0 … 16777216.0
        light paths that it learns from
    picture: integer, in paths, default 0.0, 0.0 … 9000000000000000.0
        light paths of the picture, by which trials weigh what learning costs; 0: not known, they do without
    when: text, "worthwhile" | "always", default "worthwhile"
        when paths are guided: where trials say that it pays, or always
    extend: text, default ""
        file of directions that a run has kept of this scene, to go on from; paths are then guided always; empty: none
    keep: text, default ""
        file in which all directions are kept for later runs, from the graph's folder; empty: none
    """

    def __init__(
        self,
        *inputs: Node,
        paths: int | None = ...,
        picture: int | None = ...,
        when: Literal["worthwhile", "always"] | None = ...,
        extend: str | None = ...,
        keep: str | None = ...,
        name: str | None = ...,
    ) -> None: ...

class GuideRadiance(Node):
    """an AOV, no light: the mean radiance that a guide takes to arrive, W·sr⁻¹·m⁻².

    of: node, "light directions"
        the guide
    """

    def __init__(
        self,
        *inputs: Node,
        of: Node | None = ...,
        name: str | None = ...,
    ) -> None: ...

class IrradianceCache(Node):
    """irradiance caching: light by one more bounce, computed at few points and interpolated; for diffuse light.

    Inputs: 1 that give light.

    rays: integer, in rays, default 0.0, 0.0 … 1048576.0
        rays of each record; 0: as many as the error wants, 384 to 1536
    error: number, default 0.01, 0.0001 … 1.0
        how far light may be off: less makes more records, and more rays of each
    accuracy: number, default 0.0, 0.0 … 1.0
        how far a record counts, as a part of how far its light stays about the same; 0: the root of the error
    min_spacing: number, in scene units, default 0.0, 0.0 …
        how far each record reaches at least; 0: a hundredth of the scene's radius
    max_spacing: number, in scene units, default 0.0, 0.0 …
        how far each record reaches at most; 0: a fifth of the scene's radius
    stride: integer, in pixels, default 2.0, 1.0 … 16.0
        pixels between the points of the last rehearsal: 1, 2, 4, 8 or 16
    extend: text, default ""
        file of records that a run has kept of this scene, to go on from; empty: none
    keep: text, default ""
        file in which all records are kept for later runs, from the graph's folder; empty: none
    glossy_rays: integer, in rays, default 1.0, 1.0 … 65536.0
        rays of glossy surfaces and of points in media, per question
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        rays: int | None = ...,
        error: float | None = ...,
        accuracy: float | None = ...,
        min_spacing: float | None = ...,
        max_spacing: float | None = ...,
        stride: int | None = ...,
        extend: str | None = ...,
        keep: str | None = ...,
        glossy_rays: int | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Outside(Node):
    """a function of the process that started this run, such as Python's: columns in, columns out.

    Inputs: 0 that give light.

    function: text
        what that process knows it by
    """

    def __init__(
        self,
        *inputs: Node,
        function: str | None = ...,
        name: str | None = ...,
    ) -> None: ...

class PathTracing(Node):
    """path tracing: indirect light, all that arrives by way of other surfaces; or all light.

    samples: integer, in samples, default 1.0, 1.0 … 65536.0
        light paths per question
    max_depth: integer, default 0.0, 0.0 … 65536.0
        surfaces that a light path may have between a lamp and the point, but for panes that it passes straight; 0: any number
    roulette_depth: integer, default 3.0, 0.0 … 65536.0
        surfaces after which paths may end by chance: Russian roulette
    paths: text, "indirect" | "all", default "indirect"
        which light: what comes by way of other surfaces, or direct light as well
    guide: node, "light directions"
        the guide that knows where light comes from; none: paths go on by surfaces alone
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        samples: int | None = ...,
        max_depth: int | None = ...,
        roulette_depth: int | None = ...,
        paths: Literal["indirect", "all"] | None = ...,
        guide: Node | None = ...,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class PhotonDensity(Node):
    """an AOV, no light: how many photons of a map there are per square scene unit.

    of: node, "photons"
        the map
    gather: integer, in photons, default 50.0, 2.0 … 65536.0
        how many of the nearest photons are counted
    radius: number, in scene units, default 0.0, 0.0 …
        how far away photons are counted; 0: a twentieth of the scene's radius
    """

    def __init__(
        self,
        *inputs: Node,
        of: Node | None = ...,
        gather: int | None = ...,
        radius: float | None = ...,
        name: str | None = ...,
    ) -> None: ...

class PhotonIrradiance(Node):
    """the light of a photon map, as irradiance computed beforehand at some photons: a quick approximation.

    of: node, "photons"
        the map
    every: integer, in photons, default 4.0, 2.0 … 65536.0
        of so many photons, one has the irradiance around it computed
    gather: integer, in photons, default 60.0, 0.0 … 65536.0
        how many of the nearest photons that takes; 0: all within the radius
    radius: number, in scene units, default 0.0, 0.0 …
        how far they may be away, and how far the irradiance counts; 0: a twentieth of the scene's radius
    """

    def __init__(
        self,
        *inputs: Node,
        of: Node | None = ...,
        every: int | None = ...,
        gather: int | None = ...,
        radius: float | None = ...,
        name: str | None = ...,
    ) -> None: ...

class PhotonMap(Node):
    """photon mapping, light sent from the lamps beforehand: caustics, or an approximation of all light.

    photons: integer, in photons, default 0.0, 0.0 … 4000000000.0
        light paths that leave the lamps; 0: as many as the error wants
    error: number, default 0.01, 0.001 … 1.0
        where it decides how many: how far the light of a part of the scene that gets a hundredth of it may be off
    paths: text, "caustic" | "diffuse" | "indirect" | "all", default "caustic"
        which light: by way of mirrors and glass alone, by way of a rough surface, of either, or all of it
    aim: flag, default true
        send most photons where, as trials show, they are of use
    memory: number, in MB, default 0.0, 0.0 … 1000000.0
        that the photons may take; more is an error; 0: a quarter of the machine's
    gather: integer, in photons, default 60.0, 0.0 … 65536.0
        how many of the nearest photons, or beams, an answer takes; 0: all within the radius
    radius: number, in scene units, default 0.0, 0.0 …
        how far they may be away; 0: a twentieth of the scene's radius
    beams: integer, default 10000.0, 0.0 … 1000000000.0
        light paths of which the ways through media are kept, where there are any; 0: answers in media are black
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        photons: int | None = ...,
        error: float | None = ...,
        paths: Literal["caustic", "diffuse", "indirect", "all"] | None = ...,
        aim: bool | None = ...,
        memory: float | None = ...,
        gather: int | None = ...,
        radius: float | None = ...,
        beams: int | None = ...,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class PhotonPositions(Node):
    """an AOV, no light: a dot around each photon of a map.

    of: node, "photons"
        the map
    size: number, in scene units, default 0.0, 0.0 …
        radius of the dots; 0: a three-hundredth of the scene's radius
    """

    def __init__(
        self,
        *inputs: Node,
        of: Node | None = ...,
        size: float | None = ...,
        name: str | None = ...,
    ) -> None: ...

class ProgressivePhotonMapping(Node):
    """progressive photon mapping: each sample has photons of its own, and is sharper than the one before.

    photons: integer, in photons, default 100000.0, 1.0 … 4000000000.0
        light paths that leave the lamps for each sample of the pixels
    paths: text, "caustic" | "diffuse" | "indirect" | "all", default "caustic"
        which light: by way of mirrors and glass alone, by way of a rough surface, of either, or all of it
    aim: flag, default true
        send most photons where, as trials show, they are of use
    memory: number, in MB, default 0.0, 0.0 … 1000000.0
        that the photons may take; more is an error; 0: a quarter of the machine's
    alpha: number, default 0.6666666666666666, 0.01 … 1.0
        how slowly the radius shrinks: 1 keeps it
    radius: number, in scene units, default 0.0, 0.0 …
        within which photons of the first sample count; 0: 0.013 of the scene's radius
    beams: integer, default 1000.0, 0.0 … 1000000000.0
        light paths of each sample of which the ways through media are kept; 0: answers in media are black
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        photons: int | None = ...,
        paths: Literal["caustic", "diffuse", "indirect", "all"] | None = ...,
        aim: bool | None = ...,
        memory: float | None = ...,
        alpha: float | None = ...,
        radius: float | None = ...,
        beams: int | None = ...,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class RayTracer(Node):
    """makes the image: follows rays from the eye through mirrors and glass, and asks how bright things are.

    Inputs: 1 that give light.

    scene: scene
        what is seen
    film: film
        width, height, and file of the image
    samples: integer, in samples, default 16.0, 1.0 … 16777216.0
        samples per pixel; with a noise threshold: at most
    error: number, default 0.0, 0.0 … 1.0
        noise threshold: ends a cell of 8 x 8 pixels before it has all samples, when the mean error of its pixels, each relative to the square root of its brightness, is estimated at this, as in Cycles: 0.1 (drafts) … 0.001; 0: never
    least_samples: integer, in samples, default 32.0, 1.0 … 16777216.0
        with a noise threshold: what every pixel gets, in whole blocks of 16, and at least 32
    max_depth: integer, default 100.0, 0.0 … 255.0
        how many mirrors or panes in a row a ray is followed through
    show: list of nodes, default []
        operators whose own light is kept beside the image, as layers that are not added up: AOVs
    layers: table of names
        layers by light path expressions, like caustics = "C.*DS+L", instead of one for each of the operators that they take
    alpha: flag, default false
        adds a channel A: how much of each pixel surfaces cover
    background: flag, default true
        shows what surrounds the scene where nothing is before it; it lights things in any case
    filter: text, "box" | "tent" | "gaussian", default "box"
        the pixel filter
    filter_radius: number, in pixels, default 0.0, 0.0 … 16.0
        how far the filter reaches; 0: as is usual (box 0.5, tent 1, gaussian 1.5)
    lamps: name or list of names, default []
        groups of the scene's lamps that it looks for; none: all lamps
    groups: flag, default false
        keeps the scene's groups of lamps apart: a layer for each
    """

    def __init__(
        self,
        *inputs: Node,
        scene: Node | None = ...,
        film: Sequence[int] | Mapping[str, Any] | None = ...,
        samples: int | None = ...,
        error: float | None = ...,
        least_samples: int | None = ...,
        max_depth: int | None = ...,
        show: Sequence[Node] | None = ...,
        layers: Mapping[str, str | Sequence[str]] | None = ...,
        alpha: bool | None = ...,
        background: bool | None = ...,
        filter: Literal["box", "tent", "gaussian"] | None = ...,
        filter_radius: float | None = ...,
        lamps: str | Sequence[str] | None = ...,
        groups: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class RecordPositions(Node):
    """an AOV, no light: a dot around each record of an irradiance cache.

    of: node, "irradiance records"
        the cache
    size: number, in scene units, default 0.0, 0.0 …
        radius of the dots; 0: a three-hundredth of the scene's radius. No further than the record itself reaches
    """

    def __init__(
        self,
        *inputs: Node,
        of: Node | None = ...,
        size: float | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Scale(Node):
    """its input times a number, and times a colour.

    Inputs: 1 that give light.

    factor: number, default 1.0, 0.0 …
        for all colours
    colour: numbers, default [], 0.0 …
        factors for red, green and blue; none: all 1
    """

    def __init__(
        self,
        *inputs: Node,
        factor: float | None = ...,
        colour: Sequence[float] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Scene(Node):
    """what is seen: Scene { "file.pbrt" }, the file named from the graph's folder.

    camera: table
        changes the camera; what is left out stays as the file says
    seen_by: text
        one of several cameras of the file, by its name or number (1, 2, …)
    environment: file or colour
        instead of what the file has around the scene; images: equal-area where square, else latitude-longitude
    sky: table
        a clear sky in daytime and its sun, instead of what the file has around the scene
    fog: table
        fills all space with fog, but for the inside of solid glass and of what the file fills by itself
    environment_scale: number, default 1.0, 0.0 …
        times what is around the scene
    exposure: number, in stops, default 0.0, -64.0 … 64.0
        how many times the image becomes twice as bright
    constants: table
        values for variables of the file (Mitsuba's <default>s), by their names
    variant: text
        one of several variants of the file's materials (glTF), by its name
    subdivision: table
        how often faces of objects of an OBJ file are split, 0 to 8 times, into a smooth surface (Catmull and Clark's): by the objects' names, * for any part of one; 3 where the file has tags of subdivision
    pbrt: integer, 3.0 … 4.0
        the version of pbrt, 3 or 4, whose meaning a .pbrt file has; else what it says by itself tells
    animation: text
        one of several animations of the file (glTF): its name, its number from 1 on, or * for all at once; else the first
    time: number, in seconds
        of what moves in the file; else that of the frame, and in a still all stands as the file has it
    shutter: numbers, in frames
        when it opens and closes, after the time: { 0, 0.5 } is half a frame, a shutter of 180 degrees; what moves in the file meanwhile is blurred; else that of the file's own camera (pbrt, Mitsuba), in a still
    fps: number, 1e-06 …
        frames per second, of which the shutter's are; else those of the graph
    next: table
        the scene one frame later, for a shutter and for who asks for motion; found in the graph's own frames
    next_camera: table
        'camera' one frame later; found in the graph's own frames
    previous: table
        the scene one frame earlier, for a shutter that opens then; found in the graph's own frames
    previous_camera: table
        'camera' one frame earlier; found in the graph's own frames
    material: text, "clay"
        clay: all surfaces are grey and diffuse; lamps and cut-outs stay
    groups: table of names
        groups of lamps, each the names of its lamps, * for any part of one; what is in none is in 'rest'
    ies: table of names
        profiles of luminaires (.ies) for points and spots, by the lamps' names, * for any part of one
    ies_down: numbers
        straight down of points with such profiles, in world space; else -z of their own axes in the file
    lamps: table of colours, 0.0 …
        times which lamps shine as in the file, by their names, * for any part of one, environment: around
    colours: table of colours, 0.0 … 1.0
        colours of materials instead of the file's, by their names, * for any part of one
    roughness: table of colours, 0.0 … 1.0
        roughness of materials instead of the file's, 0: smooth, by their names, * for any part of one
    two_sided: flag
        surfaces that the file has black from behind (Mitsuba's, without a twosided) look alike on both sides
    """

    def __init__(
        self,
        *inputs: str | PathLike[str] | World,
        camera: Mapping[str, Any] | None = ...,
        seen_by: str | None = ...,
        environment: str | Sequence[float] | None = ...,
        sky: Mapping[str, Any] | None = ...,
        fog: Mapping[str, Any] | None = ...,
        environment_scale: float | None = ...,
        exposure: float | None = ...,
        constants: Mapping[str, Any] | None = ...,
        variant: str | None = ...,
        subdivision: Mapping[str, Any] | None = ...,
        pbrt: int | None = ...,
        animation: str | None = ...,
        time: float | None = ...,
        shutter: Sequence[float] | None = ...,
        fps: float | None = ...,
        next: Mapping[str, Any] | None = ...,
        next_camera: Mapping[str, Any] | None = ...,
        previous: Mapping[str, Any] | None = ...,
        previous_camera: Mapping[str, Any] | None = ...,
        material: Literal["clay"] | None = ...,
        groups: Mapping[str, str | Sequence[str]] | None = ...,
        ies: Mapping[str, str | Sequence[str]] | None = ...,
        ies_down: Sequence[float] | None = ...,
        lamps: Mapping[str, float | Sequence[float]] | None = ...,
        colours: Mapping[str, float | Sequence[float]] | None = ...,
        roughness: Mapping[str, float | Sequence[float]] | None = ...,
        two_sided: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class Select(Node):
    """its input on surfaces of one material, of one object, in a box, in media, or by a way through hair; black elsewhere.

    Inputs: 1 that give light.

    material: text, default ""
        name that the scene's file gives to the material, * for any part of it; empty: any
    object: text, default ""
        name of the object or shape in the scene's file, * for any part of it; empty: any
    box: numbers, in scene units, default []
        lower x, y, z and upper x, y, z; empty: anywhere
    where: text, "anywhere" | "surfaces" | "media", default "anywhere"
        on surfaces alone, or where media scatter light
    hair: text, "all" | "R" | "TT" | "TRT", default "all"
        of hair alone what fibres reflect (R), let through (TT), or reflect inside (TRT)
    except: flag, default false
        all other places instead
    """

    def __init__(
        self,
        *inputs: Node,
        material: str | None = ...,
        object: str | None = ...,
        box: Sequence[float] | None = ...,
        where: Literal["anywhere", "surfaces", "media"] | None = ...,
        hair: Literal["all", "R", "TT", "TRT"] | None = ...,
        except_: bool | None = ...,
        name: str | None = ...,
    ) -> None: ...

class SurfaceFact(Node):
    """an AOV, no light: one fact about the first surface that the eye meets, mirrors and glass included.

    of: text, "coverage" | "depth" | "distance" | "position" | "normal" | "camera_normal" | "uv" | "motion" | "albedo"
        coverage: 1; depth: along the camera's axis; distance: from the eye; position and normal: in the world; camera_normal: x right, y up, z to the eye; uv: of the texture; motion: pixels to the right and upwards until the next frame; albedo: of all lobes, towards the eye
    """

    def __init__(
        self,
        *inputs: Node,
        of: Literal["coverage", "depth", "distance", "position", "normal", "camera_normal", "uv", "motion", "albedo"] | None = ...,
        name: str | None = ...,
    ) -> None: ...

class SurfaceFeature(Node):
    """an AOV, no light: a feature of the first surface that is no mirror or glass, times what of it reaches the eye; 'clean' of a film shows them.

    of: text, "albedo" | "normal" | "depth"
        albedo: of rough lobes, towards the eye; normal: in the world, towards the eye; depth: the distance from the eye
    """

    def __init__(
        self,
        *inputs: Node,
        of: Literal["albedo", "normal", "depth"] | None = ...,
        name: str | None = ...,
    ) -> None: ...
