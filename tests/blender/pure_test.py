"""Functions of the add-on that know nothing of Blender."""

import unittest

import numpy

from lightnet import graph, motion, report, strands, surfaces, values, volumes, xml


def picture(pixels, **more):
    return values.Picture(lambda: numpy.array(pixels, numpy.float32), **more)


class Values(unittest.TestCase):
    def test_of_a_chain_over_one_picture_are_one_picture(self):
        one = picture([[(0, 0, 0, 1), (1, 1, 1, 1)]], mapping=(2.0, 1.0, 0.0, 0.0, 0.0))
        result = values.mixed(one, values.constant(0.5, 0, 0), values.constant(0.5))
        self.assertEqual(result.mapping, one.mapping)
        numpy.testing.assert_allclose(result.pixels[0, :, :3], [(0.25, 0, 0), (0.75, 0.5, 0.5)])

    def test_of_pictures_that_lie_otherwise_are_means(self):
        one, other = picture([[(0, 0, 0, 1), (1, 1, 1, 1)]]), picture([[(0, 0, 0, 1), (1, 1, 1, 1)]], wrap="clamp")
        numpy.testing.assert_allclose(values.scaled(one, other).pixels[0, :, 0], [0, 0.5])

    def test_of_curves_are_those_of_srgb(self):
        numpy.testing.assert_allclose(values.linear(numpy.array([0.0, 0.04, 0.5, 1.0])), [0, 0.003096, 0.214041, 1], atol=1e-6)

    def test_are_written_bottom_row_first(self):
        data = values.pfm(numpy.arange(16, dtype=numpy.float32).reshape(2, 2, 4))
        self.assertTrue(data.startswith(b"PF\n2 2\n-1.0\n"))
        numpy.testing.assert_array_equal(numpy.frombuffer(data[-48:], "<f4")[:6], [0, 1, 2, 4, 5, 6])


class Surfaces(unittest.TestCase):
    def put(self, name, value):
        return xml.number(name, value[0])

    def test_with_holes_keep_what_is_there(self):
        hole, matt = surfaces.Surface(None, values.constant(0)), surfaces.Surface(surfaces.diffuse(values.constant(0.5)))
        mixed = surfaces.mix(hole, matt, values.constant(0.25))
        self.assertAlmostEqual(mixed.opacity[0], 0.25)
        self.assertEqual(mixed.bsdf(self.put).attributes["type"], "twosided")

    def test_shine_as_much_as_their_parts(self):
        lamp = surfaces.Surface(None, emission=values.constant(8))
        mixed = surfaces.mix(lamp, surfaces.Surface(surfaces.diffuse(values.constant(0.5))), values.constant(0.25))
        self.assertAlmostEqual(mixed.emission[0], 6)
        self.assertEqual(mixed.bsdf(self.put).attributes["type"], "blendbsdf")


class Motion(unittest.TestCase):
    def test_of_what_stands_still_is_no_animation(self):
        still, goes = [[1, 0], [0, 1]], [[1, 2], [0, 1]]
        moments = [{"a": still, "b": still, "c": still}, {"a": still, "b": goes}]
        found = motion.keys_of([0, 1], moments)
        self.assertEqual(found, {"b": [(0, still), (1, goes)]})
        self.assertEqual(motion.Way(still, found.get("a")).element().tag, "transform")
        lines = list(motion.Way(still, found["b"]).element().lines())
        self.assertEqual(lines[0], '<animation name="to_world">')
        self.assertEqual(lines[4:7], [' <transform time="1.0">', '  <matrix value="1.0 2.0 0.0 1.0"/>', " </transform>"])


class Strands(unittest.TestCase):
    def test_go_through_their_points(self):
        points = numpy.random.default_rng(1).normal(size=(3, 5, 4))
        knots = strands.through(points)
        numpy.testing.assert_allclose((knots[:, :-2] + 4 * knots[:, 1:-1] + knots[:, 2:]) / 6, points, atol=1e-12)

    def test_without_length_are_left_out(self):
        points = numpy.array([[(0, 0, 0, 1), (0, 0, 2, 1)], [(3, 0, 0, 1), (3, 0, 0, 1)]], float)
        text = strands.text([points]).decode()
        self.assertEqual(text.strip().split("\n"), ["0 0 -1 1", "0 0 0 1", "0 0 1 1", "0 0 2 1", "0 0 3 1"])

    def test_are_thinner_to_their_ends(self):
        part = numpy.array([[0.0, 0.5, 1.0]])
        numpy.testing.assert_allclose(strands.radii(part, 1, 0.2, 0, False), [[1, 0.6, 0.2]])
        numpy.testing.assert_allclose(strands.radii(part, 1, 0.2, 0.5, True), [[1, 0.4, 0]])
        numpy.testing.assert_allclose(strands.along(numpy.array([[(0, 0, 0), (3, 4, 0), (3, 4, 15)]])), [[0, 0.25, 1]])

    def test_are_dark_by_pigments_and_by_colour(self):
        numpy.testing.assert_allclose(strands.absorption_of_melanin(0, 0.5), [0, 0, 0])
        numpy.testing.assert_allclose(strands.absorption_of_melanin(1 - numpy.exp(-2), 0), [1.012, 1.682, 3.306])
        found = strands.absorption_of_colour(numpy.array((1.0, 0.5, 0.1)), 0.3)
        numpy.testing.assert_allclose(found, [0, 0.0138565, 0.1529095], rtol=1e-5)  # (ln c / 5.88841)²


class Volumes(unittest.TestCase):
    def test_scatter_by_the_mean_cosine_of_their_parts(self):
        white = numpy.ones(3)
        both = volumes.scatter(white, 1.0, 0.8) + volumes.scatter(white, 3.0, 0.0)
        self.assertAlmostEqual(both.cosine(), 0.2)
        self.assertTrue(volumes.absorb(white, 5.0).is_empty())

    def test_of_principled_absorb_what_does_not_scatter(self):
        grey = numpy.full(3, 0.5)
        found = volumes.principled(grey, 2.0, 0.0, numpy.array((0, 0.25, 1)), numpy.zeros(3))
        numpy.testing.assert_allclose(found.scattering, [1, 1, 1])
        numpy.testing.assert_allclose(found.absorption, [1, 0.5, 0])

    def test_are_written_as_colours_up_to_one_and_a_scale(self):
        lines = "\n".join(volumes.Volume(numpy.array((1.0, 2, 0)), numpy.array((3.0, 0, 0))).element("smoke").lines())
        self.assertIn('name="sigma_t" value="1.0 0.5 0.0"', lines)
        self.assertIn('name="scale" value="4.0"', lines)
        self.assertIn('name="albedo" value="0.25 1.0 0.0"', lines)
        self.assertNotIn("phase", lines)
        self.assertNotIn("emission", lines)


class Words(unittest.TestCase):
    def test_of_xml_are_quoted(self):
        lines = list(xml.Element("scene", version="3").add(xml.word("name", 'a"<b')).lines())
        self.assertEqual(lines, ['<scene version="3">', " <string name=\"name\" value='a\"&lt;b'/>", "</scene>"])

    def test_of_graphs_have_groups_where_lightings_know_them(self):
        groups = {"key": ['lamp"1']}
        self.assertIn('groups = { key = { "lamp\\"1" } }', graph.text_of("path", (8, 4), 16, groups=groups))
        self.assertNotIn("groups", graph.text_of("figure5", (8, 4), 16, groups=groups))

    def test_of_graphs_name_frames_beside_for_vectors(self):
        text = graph.text_of("path", (8, 4), 16, shown=["Vector"], later="b.xml")
        self.assertIn('Scene { "scene.xml", next = { file = "b.xml", time = 0 } }', text)
        self.assertIn('Vector = SurfaceFact { of = "motion" }', text)
        self.assertIn('Scene { "scene.xml", next = { file = "a.xml", time = 0 } }', graph.backwards_of((8, 4), 16, "a.xml"))

    def test_of_reports_come_once(self):
        told = report.Report()
        for place in ("a", "b", "a", "c"):
            told.missing("hairs", place)
        self.assertEqual(list(told.lines()), ["hairs are left out (a, and 2 others)"])


unittest.main()
