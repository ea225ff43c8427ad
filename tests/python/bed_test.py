"""Layers, surface and Shields number of beds whose answers are known."""
import unittest

import h5py
import numpy as np

import made_up_folder as made_up
import thalweg
from thalweg import bed, literature
from thalweg.height_profiles import surface_or_floor
from thalweg.layers import LayerSums, disk_below, layer_profiles, parts_in_layers, volume_below
from thalweg.mesh_volume import volumes_in_layers
from thalweg.obstacles import obstacles, union_in_layers

D, SIZE = 4.95e-3, np.array([0.12, 0.0105, 0.1485])


class Parts(unittest.TestCase):
    def test_of_a_sphere_and_a_disk(self):
        # Half of each below the middle, all below the top, the cap pi h^2 (3 R - h)/3 and the segment of 60 degrees.
        self.assertAlmostEqual(volume_below(0.0, 2.0), 2 / 3 * np.pi * 8, 12)
        self.assertAlmostEqual(volume_below(5.0, 2.0), 4 / 3 * np.pi * 8, 12)
        self.assertEqual(volume_below(-2.0, 2.0), 0.0)
        self.assertAlmostEqual(volume_below(-1.5, 2.0), np.pi * 0.25 * 5.5 / 3, 12)
        self.assertAlmostEqual(disk_below(-1.0, 2.0), 4 * (np.pi / 3 - np.sqrt(3) / 4), 12)
        self.assertAlmostEqual(disk_below(9.0, 2.0), np.pi * 4, 12)

    def test_nothing_is_lost(self):
        generator = np.random.default_rng(1)
        height, radius = generator.uniform(0.2, 0.8, 50), generator.uniform(0.05, 0.2, 50)
        part = parts_in_layers(np.linspace(0, 1, 31), height, radius)
        np.testing.assert_allclose(part.sum(axis=0), 4 / 3 * np.pi * radius**3, rtol=1e-12)
        self.assertTrue((part >= 0).all())


class Layers(made_up.MadeUpFolder):
    def test_means_of_two_grains(self):
        # Both centred on the edge between two layers a diameter thick, so that half of each is in each; velocities 1
        # and 3 along x: mean 2, temperature 1/3 of the variance 1.
        place = np.array([[[0.01, 0.005, D], [0.05, 0.005, D]]])
        velocity = np.array([[[1.0, 0, 0], [3.0, 0, 0]]])
        stress = np.zeros((1, 2, 9))
        stress[0, :, 2], stress[0, :, 6] = (3.0, 5.0), (1.0, 1.0)   # xz, zx
        self.write_frames((0.5,), place, velocity=velocity, fluid_stress=stress)
        sums = LayerSums(np.array([0.0, D, 2 * D, 3 * D]), SIZE[0] * SIZE[1])
        sums.add(thalweg.Run(self.folder).grains[0])
        found = sums.profiles()
        fraction = np.pi / 6 * D**3 / (SIZE[0] * SIZE[1] * D)
        np.testing.assert_allclose(found["solid_fraction"], (fraction, fraction, 0.0), rtol=1e-12)
        np.testing.assert_allclose(found["velocity"][:2, 0], 2.0, rtol=1e-12)
        self.assertTrue(np.isnan(found["velocity"][2]).all())
        np.testing.assert_allclose(found["flux"][:2, 0], 2.0 * fraction, rtol=1e-12)
        np.testing.assert_allclose(found["granular_temperature"][:2], 1 / 3, rtol=1e-12)
        np.testing.assert_allclose(found["rotation_stress"], np.array([3.0, 3.0, 0.0]) * fraction, rtol=1e-12)

    def test_velocity_by_mass_and_flux_by_volume(self):
        # Equal spheres of 1000 and 3000 kg/m^3 at 1 and 3 m/s along x: velocity (1 + 3 * 3)/4 = 2.5, temperature a third
        # of the variance (1 + 3 * 9)/4 - 2.5^2 = 0.75, flux the mean of both, 2, times the solid fraction.
        place = np.array([[[0.01, 0.005, D], [0.05, 0.005, D]]])
        velocity = np.array([[[1.0, 0, 0], [3.0, 0, 0]]])
        self.write_frames((0.0,), place, velocity=velocity, density=np.array([[1000.0, 3000.0]]))
        sums = LayerSums(np.array([0.0, D, 2 * D]), SIZE[0] * SIZE[1])
        sums.add(thalweg.Run(self.folder).grains[0])
        found = sums.profiles()
        np.testing.assert_allclose(found["velocity"][:, 0], 2.5, rtol=1e-12)
        np.testing.assert_allclose(found["granular_temperature"], 0.25, rtol=1e-12)
        np.testing.assert_allclose(found["flux"][:, 0], 2.0 * found["solid_fraction"], rtol=1e-12)

    def test_disks_in_layers_as_wide_as_they_are_thick(self):
        # pi/4 of a square array, whatever the width of the box.
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("system: resolved", "system: resolved\ndisks: {thickness: 4.0e-3}"))
        x, z = np.meshgrid((np.arange(24) + 0.5) * SIZE[0] / 24, (np.arange(30) + 0.5) * D)
        places = np.column_stack([x.ravel(), np.full(x.size, 0.5 * SIZE[1]), z.ravel()])
        self.write_frames((0.0,), [places], radius=[np.full(x.size, 0.5 * D)])
        found = layer_profiles(thalweg.Run(self.folder), thickness=D)
        np.testing.assert_allclose(found["solid_fraction"][:29], 0.25 * np.pi * D / (SIZE[0] / 24), rtol=1e-2)

    def test_grains_across_a_periodic_top(self):
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("bottom: no_slip, top: free_slip", "z: periodic"))
        self.write_frames((0.0,), [np.array([[0.05, 0.005, 0.0]])])
        found = layer_profiles(thalweg.Run(self.folder), thickness=SIZE[2] / 30)
        volume = found["solid_fraction"] * SIZE[0] * SIZE[1] * SIZE[2] / 30
        self.assertAlmostEqual(volume[0] / volume[-1], 1.0, 9)
        self.assertAlmostEqual(volume.sum() / (np.pi / 6 * D**3), 1.0, 9)

    def test_members_of_clumps_are_refused(self):
        self.write_frames((0.0,), [np.array([[0.05, 0.005, 0.01], [0.053, 0.005, 0.01]])], clump=[np.array([0, 0])])
        with self.assertRaisesRegex(thalweg.RunFolderError, "grain_profiles"):
            layer_profiles(thalweg.Run(self.folder))
        # Where the fields of the frames leave out which they are, the case tells.
        self.write_frames((0.0,), [np.array([[0.05, 0.005, 0.01], [0.053, 0.005, 0.01]])])
        layer_profiles(thalweg.Run(self.folder))
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("count: 969,", "count: 1, shape: {clump: [{}, {}]},"))
        with self.assertRaisesRegex(thalweg.RunFolderError, "grain_profiles"):
            layer_profiles(thalweg.Run(self.folder))

    def bed_of_layers(self, layers):
        """24 x 2 grains a layer, layers one diameter apart, and one grain that flies."""
        x, y, z = np.meshgrid((np.arange(24) + 0.5) * SIZE[0] / 24, (0.3 * SIZE[1], 0.7 * SIZE[1]),
                              (np.arange(layers) + 0.5) * D)
        return np.vstack([np.column_stack([x.ravel(), y.ravel(), z.ravel()]), [0.06, 0.005, (layers + 6) * D]])

    def test_the_fluid_stress_of_the_start_is_not_known(self):
        places = self.bed_of_layers(3)
        stress = np.tile(np.arange(9.0), (len(places), 1))
        self.write_frames((0.0, 0.5, 1.0), [places] * 3, fluid_stress=[0.0 * stress, stress, stress],
                          contact_stress=[stress, stress, 4.0 * stress])
        found = layer_profiles(thalweg.Run(self.folder), thickness=D)
        share = found["solid_fraction"][1]
        np.testing.assert_allclose(found["fluid_stress"][1].ravel(), share * np.arange(9.0))
        np.testing.assert_allclose(found["contact_stress"][1].ravel(), 2.0 * share * np.arange(9.0))
        self.assertAlmostEqual(found["rotation_stress"][1], share * (2.0 - 6.0))

    def test_the_shields_number_of_an_inclined_gravity(self):
        case = self.folder / "case.yaml"
        plain = bed.shields_number(thalweg.Run(self.folder), 10 * D)
        case.write_text(case.read_text().replace("gravity: {magnitude: 9.8, slope: 0.0748}", "gravity: {vector: [0.3, 3, -9.3]}"))
        share = 0.3 / np.linalg.norm([0.3, 3.0, -9.3]) / np.sin(np.arctan(0.0748))
        self.assertAlmostEqual(bed.shields_number(thalweg.Run(self.folder), 10 * D) / plain, share, 12)

    def test_a_single_layer_has_no_surface(self):
        with self.assertRaisesRegex(thalweg.RunFolderError, "a single layer"):
            bed.surface_by_solid_fraction([D], [0.5], D)

    def test_profiles_of_nothing(self):
        for nothing in (0.0, np.nan):
            with self.assertRaisesRegex(thalweg.RunFolderError, "nothing has been measured"):
                bed.surface_by_solid_fraction(D * np.arange(5), np.full(5, nothing))

    def test_the_surface_lies_between_two_layers(self):
        # Of 3.08, a tenth lies below 0.616 and half below 2 + 0.44/0.7: the bed has 1.232 in that height.
        fraction = [0.5, 0.6, 0.7, 0.6, 0.45, 0.15, 0.02, 0.02, 0.02, 0.02]
        half = 0.5 * 1.232 / (2.0 + 0.44 / 0.7 - 0.616)
        self.assertAlmostEqual(bed.surface_by_solid_fraction(np.arange(10) + 0.5, fraction), 4.5 + (0.45 - half) / 0.3, 12)
        # A block with a flat top that fills 60 % of a layer has its height, in means over four layers.
        block = np.r_[np.full(13, 0.6), 0.36, np.zeros(6)]
        self.assertAlmostEqual(bed.surface_by_solid_fraction(0.25 * (np.arange(20) + 0.5), block, 1.0), 3.4, 12)
        for alone in np.linspace(0.1, 0.6, 51):   # all grains in one layer, whatever the rounding: half-way to the next
            self.assertAlmostEqual(bed.surface_by_solid_fraction([0.1, 0.3, 0.7], [alone, 0.0, 0.0]), 0.2, 12)

    def test_the_surface_by_solid_fraction(self):
        # Half of the top layer's volume is where its solid fraction has fallen to half in layers a diameter thick: at
        # the top.
        places = self.bed_of_layers(10)
        self.write_frames((0.0, 1.0), [places, places])
        run = thalweg.Run(self.folder)
        profiles = layer_profiles(run, thickness=D)
        height = bed.surface_by_solid_fraction(profiles["z"], profiles["solid_fraction"])
        self.assertAlmostEqual(height / D, 10.0, 6)
        self.assertLess(abs(bed.bed_height(run) / D - 10.0), 0.25)   # in layers of a quarter
        depth = SIZE[2] - height
        exact = np.sin(np.arctan(0.0748)) * depth * SIZE[1] / (2 * depth + SIZE[1]) / (1.55 * D)
        self.assertAlmostEqual(bed.shields_number(run, height), exact, 12)
        # Beside one wall, and where something else drives the flow.
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("y: {type: law_of_the_wall}", "y_low: no_slip, y_high: free_slip"))
        exact = np.sin(np.arctan(0.0748)) * depth * SIZE[1] / (depth + SIZE[1]) / (1.55 * D)
        self.assertAlmostEqual(bed.shields_number(thalweg.Run(self.folder), height), exact, 12)
        case.write_text(case.read_text().replace("slope: 0.0748", "slope: 0"))
        (self.folder / "series.csv").write_text("time [s],shields_number [1]\n0,0.07\n1,0.09\n2,0.2\n")
        self.assertAlmostEqual(bed.shields_number(thalweg.Run(self.folder), height, 0.0, 1.0), 0.08, 12)

    def with_a_post(self, fixed):
        """The bed with a post of spheres a quarter of a diameter apart through the whole depth, fixed in the case or
        not."""
        post = np.column_stack([np.full(100, 0.0625), np.full(100, 0.5 * SIZE[1]), D * (0.5 + 0.25 * np.arange(100))])
        bed_grains = self.bed_of_layers(10)[:-1]
        apart = np.linalg.norm((bed_grains - post[0])[:, :2], axis=1)
        places = np.vstack([post, bed_grains[apart > D]])
        self.write_frames((0.0, 1.0), [places, places])
        if fixed:
            case = self.folder / "case.yaml"
            case.write_text(
                case.read_text().replace(
                    "grains: [{",
                    "grains: [{diameter: 4.95e-3, density: 2550, fixed: true, "
                    f"placement: {{positions: {post.tolist()}}}}}, {{",
                )
            )
        return thalweg.Run(self.folder), post, places

    def test_a_post_of_overlapping_spheres_is_no_bed(self):
        run, post, places = self.with_a_post(fixed=True)
        self.assertEqual(np.flatnonzero(obstacles(run, run.grains[0])).tolist(), list(range(len(post))))
        profiles = layer_profiles(run, thickness=D)
        # Nearly a cylinder: r^2 less a twelfth of the quarter of a diameter, squared.
        radius = 0.5 * D
        room = SIZE[0] * SIZE[1] - np.pi * (radius**2 - (0.25 * D)**2 / 12.0)
        grains_a_layer = (len(places) - len(post)) / 10
        right = grains_a_layer * np.pi / 6 * D**3 / (room * D)
        layers = profiles["z"] < 9.5 * D
        np.testing.assert_allclose(profiles["solid_fraction"][layers][1:], right, rtol=2e-3)
        self.assertLess(abs(bed.bed_height(run) / D - 10.0), 0.25)
        # It takes a part of the force of the slope, which only the run knows.
        (self.folder / "series.csv").write_text("time [s],shields_number [1]\n0,0.07\n1,0.09\n")
        self.assertAlmostEqual(bed.shields_number(run, 10 * D), 0.08, 12)

    def test_means_that_hold_obstacles_do_not_tell_the_surface(self):
        # profiles.h5 counts a sill of overlapping spheres like grains, up to 20 diameters; the bed ends at 10.
        run, _, _ = self.with_a_post(fixed=True)
        z = (np.arange(60) + 0.5) * 0.5 * D
        fraction = np.where(z < 20 * D, 0.6, 0.0)
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            file["grain_profiles/z"], file["grain_profiles/solid_fraction"] = z, fraction
        self.assertLess(abs(bed.bed_height(run) / D - 10.0), 0.25)
        surface, name = surface_or_floor(run, z, fraction)
        self.assertLess(abs(surface / D - 10.0), 0.25)
        self.assertEqual(name, "bed surface")

    def test_grains_up_to_the_top_have_no_surface(self):
        # Up to half a diameter below it, and up to two.
        self.write_frames((0.0,), [self.bed_of_layers(10)])
        run = thalweg.Run(self.folder)
        z = (np.arange(120) + 0.5) * SIZE[2] / 120
        for gap, right in ((0.5, (0.0, "floor")), (2.0, (SIZE[2] - 2.0 * D, "bed surface"))):
            surface, name = surface_or_floor(run, z, np.where(z < SIZE[2] - gap * D, 0.5, 0.0))
            self.assertLess(abs(surface - right[0]), SIZE[2] / 120)
            self.assertEqual(name, right[1])

    def test_what_is_an_obstacle(self):
        # docs/input.md, "Bed surface": of grains held at positions those at least twice as large as the largest free one,
        # and those that overlap by more than a twentieth of the smaller diameter.
        fixed = D * np.array([[3, 1, 3], [8, 1, 3], [13, 1, 1], [13.94, 1, 1], [17, 1, 1], [17.96, 1, 1]])
        radius = D * np.array([1.01, 0.99] + 4 * [0.5] + [0.5, 0.4])   # the last two are free
        places = np.vstack([fixed, D * np.array([[5, 1, 8], [6, 1, 8]])])
        self.write_frames((0.0,), [places], radius=[radius])
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace(
            "grains: [{", f"grains: [{{fixed: true, placement: {{positions: {fixed.tolist()}}}}}, {{"))
        run = thalweg.Run(self.folder)
        np.testing.assert_array_equal(np.flatnonzero(obstacles(run, run.grains[0])), (0, 2, 3))
        # A floor of larger grains that are held, at no positions of the case, is none of the free ones.
        held = np.array(6 * [3] + [0, 3])
        radius[-1] = 0.8 * D
        for which, found in ({"held": [held]}, (0, 2, 3)), ({}, (2, 3)):
            self.write_frames((0.0,), [places], radius=[radius], **which)
            run = thalweg.Run(self.folder)
            np.testing.assert_array_equal(np.flatnonzero(obstacles(run, run.grains[0])), found)

    def test_grains_that_float_are_no_bed(self):
        # A raft of a layer below the lid, as dense as the bed.
        still = self.bed_of_layers(10)[:-1]
        raft = still[np.isclose(still[:, 2], 0.5 * D)] + [0.0, 0.0, SIZE[2] - D]
        places = np.vstack([still, raft])
        density = np.where(np.arange(len(places)) < len(still), 2550.0, 900.0)
        frames = 4
        self.write_frames(0.2 * np.arange(frames), [places] * frames, density=[density] * frames)
        run = thalweg.Run(self.folder)
        self.assertLess(abs(bed.bed_height(run) / D - 10.0), 0.25)
        self.assertLess(bed.static_bed_height(run, frames=1) / D, 10.0)
        self.assertGreater(np.sum(layer_profiles(run)["solid_fraction"][-3:]), 0.1)   # profiles have all grains
        # Where there is nothing else, they are a bed like others.
        self.write_frames((0.0,), [raft], density=[density[len(still):]])
        with self.assertRaisesRegex(thalweg.RunFolderError, "reach the top"):
            bed.bed_height(thalweg.Run(self.folder))

    def test_obstacles_are_not_what_stands_still(self):
        # A boulder four diameters wide that stands half out of the bed.
        still, frames = self.bed_of_layers(8), 4
        boulder = D * np.array([[5.0, 1.0, 8.0]])
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace(
            "grains: [{", f"grains: [{{fixed: true, placement: {{positions: {boulder.tolist()}}}}}, {{"))
        times = 0.2 * np.arange(frames)
        self.write_frames(times, [still] * frames)
        right = bed.static_bed_height(thalweg.Run(self.folder), frames=1)
        places = np.vstack([boulder, still])
        radius = np.r_[2.0 * D, np.full(len(still), 0.5 * D)]
        self.write_frames(times, [places] * frames, radius=[radius] * frames)
        self.assertEqual(bed.static_bed_height(thalweg.Run(self.folder), frames=1), right)

    def test_solids_that_stand_still_take_their_room(self):
        # A block over a quarter of the length, as high as half of the box, and another one that moves.
        case = self.folder / "case.yaml"
        case.write_text(case.read_text() + "solids: [{stl: block.stl}, {stl: blade.stl, motion: {velocity: [1, 0, 0]}}]\n")
        corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)])
        block = corners * (0.25 * SIZE[0], SIZE[1], 0.5 * SIZE[2])
        faces = np.array([(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6),
                          (0, 6, 2), (1, 3, 7), (1, 7, 5)])
        made_up.write_triangles(
            self.folder / "solids.vtp", np.vstack([block, block + D]), np.vstack([faces, faces + 8]),
            {"solid": np.repeat([0, 1], 12)},
        )
        made_up.write_index(self.folder / "solids.pvd", [(0.0, "solids.vtp")])
        places = self.bed_of_layers(10)[:-1]
        places = places[places[:, 0] > 0.25 * SIZE[0]]
        self.write_frames((0.0, 1.0), [places, places])
        run = thalweg.Run(self.folder)
        room = 0.75 * SIZE[0] * SIZE[1] * D
        profiles = layer_profiles(run, thickness=D)
        np.testing.assert_allclose(
            profiles["solid_fraction"][:10] * room / (len(places) / 10 * np.pi / 6 * D**3), 1.0, rtol=1e-3
        )
        self.assertLess(abs(bed.bed_height(run) / D - 10.0), 0.25)
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,0.1\n")
        with self.assertRaisesRegex(thalweg.RunFolderError, "analysis.bed_surface"):
            bed.shields_number(run, 10 * D)

    def test_the_volume_in_layers_of_a_slope(self):
        # A wedge whose top rises from 0 to 2 along x, over a plan of 4 by 3.
        points = np.array([(x, y, z) for y in (0, 3) for x, z in ((0, 0), (4, 0), (4, 2))], float)
        faces = np.array([(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)])
        edges = np.array([0.0, 0.5, 1.0, 2.0, 3.0])
        top = np.minimum(edges, 2.0)
        found = volumes_in_layers(points, faces, np.array([4.0, 3.0, 3.0]), (False, False, False), edges)
        np.testing.assert_allclose(found, np.diff(3.0 * (4.0 * top - top**2)), atol=1e-4)

    def test_the_volume_that_several_solids_enclose_counts_once(self):
        faces = np.array([(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6),
                          (0, 6, 2), (1, 3, 7), (1, 7, 5)])
        unit = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
        low, tall = unit * (2, 1, 1) + (1, 1, 0), unit * (2, 1, 2) + (2, 1, 0)
        two = np.vstack([low, tall]), np.vstack([faces, faces + 8])
        box, edges = np.array([4.0, 3.0, 2.0]), np.array([0.0, 1.0, 2.0])
        column = 4.0 / 250
        np.testing.assert_allclose(volumes_in_layers(*two, box, (False, False, False), edges), [3.0, 2.0], atol=column)
        # A rib longer than the periodic box, and a block that walls cut.
        rib = unit * (5, 1, 1) + (-1, 1, 0)
        np.testing.assert_allclose(volumes_in_layers(rib, faces, box, (True, True, False), edges), [4.0, 0.0], atol=4 * column)
        np.testing.assert_allclose(volumes_in_layers(rib, faces, box, (False, False, False), edges), [4.0, 0.0], atol=1e-9)

    def test_spheres_that_are_free_count_one_by_one(self):
        run, post, _ = self.with_a_post(fixed=False)
        self.assertFalse(obstacles(run, run.grains[0]).any())

    def test_the_union_of_two_spheres(self):
        run, _, _ = self.with_a_post(fixed=False)
        apart, radius = 0.6 * D, 0.5 * D
        lens = np.pi * (4 * radius + apart) * (2 * radius - apart)**2 / 12
        for x in (0.05, SIZE[0] - 0.2 * D):   # through a periodic face
            two = np.array([[x, 0.005, 0.02], [x + apart, 0.005, 0.02]])
            found = union_in_layers(run, np.array([0.0, 0.02, 0.04]), two, np.full(2, radius))
            self.assertLess(abs(found.sum() / (np.pi / 3 * D**3 - lens) - 1.0), 5e-3)
            self.assertLess(abs(found[0] / found[1] - 1.0), 1e-2)

    def test_profiles_of_the_run_count_for_its_own_time_only(self):
        (self.folder / "series.csv").write_text(
            "time [s],q_star [1]\n" + "".join(f"{t / 10},0.1\n" for t in range(101))
        )
        with h5py.File(self.folder / "profiles.h5", "w") as file:
            file.create_group("grain_profiles")["z"] = np.arange(3.0)
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("{transport_rate: {from: 1.0}}",
                                                 "{transport_rate: {from: 1.0}, grain_profiles: {from: 1.0}}"))
        run = thalweg.Run(self.folder)
        self.assertTrue(bed.has_profiles_of(run, 1.0, 10.0))
        # Added at a restart at 5 s: the case does not say so, the run does.
        (self.folder / "summary.json").write_text('{"grain_profiles": {"mean_from": 5.0}}')
        self.assertFalse(bed.has_profiles_of(thalweg.Run(self.folder), 1.0, 10.0))
        self.assertTrue(bed.has_profiles_of(thalweg.Run(self.folder), 5.0, 10.0))
        self.assertFalse(bed.has_profiles_of(run, 1.0, 5.0))
        self.assertFalse(bed.has_profiles_of(run, 4.0, 10.0))
        # Rows that are missing make no difference to that.
        rows = [t / 10 for t in range(101) if not 20 < t < 60]
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n" + "".join(f"{t},0.1\n" for t in rows))
        run = thalweg.Run(self.folder)
        self.assertTrue(bed.has_profiles_of(run, 5.0, 10.0))
        self.assertFalse(bed.has_profiles_of(run, 1.0, 10.0))

    def test_the_surface_by_static_pixels(self):
        # Layers at rest end 8 d high; on them a layer that slides by a diameter between frames, and one grain that
        # flies. The outline of spheres side by side is below their tops by 1 - pi/4 of half a diameter in the mean.
        still = self.bed_of_layers(8)
        moving = self.bed_of_layers(9)[-200:]
        moving = moving[np.isclose(moving[:, 2], 8.5 * D)]
        frames = [np.vstack([still, (moving + [n * D, 0, 0]) % [SIZE[0], 1, 1]]) for n in range(11)]
        for n, places in enumerate(frames):
            places[len(still) - 1, 0] = (0.06 + 0.01 * n) % SIZE[0]
        self.write_frames(np.arange(11) * 0.1, frames)
        height = bed.static_bed_height(thalweg.Run(self.folder), frames=3) / D
        self.assertLess(height, 8.0)
        self.assertGreater(height, 8.0 - 0.5 * (1 - np.pi / 4) - 2 / 25)

    def test_a_surface_where_nothing_rests(self):
        # Layers at rest end 8 d high, until all grains are swept away, by three diameters between frames.
        still = self.bed_of_layers(8)[:-1]
        swept = [(still + [3 * n * D, 0, 0]) % [SIZE[0], 1, 1] for n in range(11)]
        self.write_frames(np.arange(11) * 0.1, swept)
        with self.assertRaisesRegex(thalweg.RunFolderError, "no grain is at rest"):
            bed.static_bed_height(thalweg.Run(self.folder), frames=3)
        self.write_frames(np.arange(22) * 0.1, [still] * 11 + swept)
        height = bed.static_bed_height(thalweg.Run(self.folder), frames=3) / D
        self.assertTrue(8.0 - 0.5 * (1 - np.pi / 4) - 2 / 25 < height < 8.0)

    def test_static_pixels_need_frames(self):
        self.write_frames((0.0, 0.3), [self.bed_of_layers(2)] * 2)
        with self.assertRaisesRegex(thalweg.RunFolderError, "over 0.5 s"):
            bed.static_bed_height(thalweg.Run(self.folder))

    def test_the_transport_rate_from_where_the_case_says(self):
        (self.folder / "series.csv").write_text("time [s],q_star [1]\n0,9\n1.0,0.1\n1.5,0.3\n")
        time, rate = bed.transport_rate(thalweg.Run(self.folder))
        np.testing.assert_array_equal(rate, (0.1, 0.3))
        with self.assertRaisesRegex(thalweg.RunFolderError, "no measurement from 2 s on"):
            bed.transport_rate(thalweg.Run(self.folder), 2.0)

    def test_the_shields_number_while_gravity_rises(self):
        # The mean of 3 x^2 - 2 x^3 over the ramp of 2 s is a half, over its first second x^3 - x^4/2 at x = 1/2, twice:
        # 3/16; over 4 s it is (1 + 2)/4.
        case = self.folder / "case.yaml"
        case.write_text(case.read_text() + "run: {until: 4, ramp: 2}\n")
        (self.folder / "series.csv").write_text("time [s]\n0\n2\n4\n")
        run = thalweg.Run(self.folder)
        full = bed.shields_number(run, 10 * D)
        self.assertAlmostEqual(full, bed.shields_of(0.0748, SIZE[2] - 10 * D, D, 2.55, SIZE[1]), 12)
        for start, stop, share in ((0, 2, 0.5), (0, 1, 3 / 16), (0, np.inf, 0.75), (2, 4, 1.0), (-np.inf, 2, 0.5)):
            self.assertAlmostEqual(bed.shields_number(run, 10 * D, start, stop) / full, share, 12)

    def test_the_shields_number_after_a_restart_with_another_slope(self):
        log = "Thalweg 0.1.0 (aaa): A\nshape\nThalweg 0.1.0 (aaa): A\nshape\nresuming from a/step_5.h5 at 2 s\n"
        (self.folder / "run.log").write_text(log + "changed since then: gravity.slope: 0.02 -> 0.0748\n")
        (self.folder / "series.csv").write_text("time [s],shields_number [1]\n0,0.03\n1,0.03\n2,0.03\n3,0.1\n4,0.1\n")
        run = thalweg.Run(self.folder)
        by_depth = bed.shields_of(0.0748, SIZE[2] - 10 * D, D, 2.55, SIZE[1])
        self.assertAlmostEqual(bed.shields_number(run, 10 * D, 2.0, 4.0), by_depth, 12)
        self.assertAlmostEqual(bed.shields_number(run, 10 * D, 0.0, 2.0), 0.03, 12)
        self.assertAlmostEqual(bed.shields_number(run, 10 * D, 1.0, 4.0), 0.065, 12)
        (self.folder / "series.csv").write_text("time [s]\n0\n4\n")
        with self.assertRaisesRegex(thalweg.RunFolderError, "restart at 2 s changed what drives the flow"):
            bed.shields_number(thalweg.Run(self.folder), 10 * D, 0.0, 4.0)

    def test_the_shields_number_of_a_slope_to_the_left(self):
        plain = bed.shields_number(thalweg.Run(self.folder), 10 * D)
        case = self.folder / "case.yaml"
        case.write_text(case.read_text().replace("slope: 0.0748", "slope: -0.0748"))
        self.assertAlmostEqual(bed.shields_number(thalweg.Run(self.folder), 10 * D), -plain, 12)

    def test_rows_without_a_number_do_not_count(self):
        """As of a bed that reached the top of the box for a moment."""
        (self.folder / "series.csv").write_text("time [s],q_star [1],shields_number [1]\n"
                                                "0,0.1,0.1\n1,nan,nan\n2,0.3,0.2\n3,nan,nan\n4,nan,nan\n")
        run = thalweg.Run(self.folder)
        self.assertAlmostEqual(bed.measured_shields_number(run, 0.0, 2.0), 0.15, 12)
        np.testing.assert_array_equal(bed.transport_rate(run, 0.0)[0], (0.0, 2.0))
        with self.assertRaisesRegex(
            thalweg.RunFolderError, "no row from 3 to 4 s has a number in the column shields_number"
        ):
            bed.measured_shields_number(run, 3.0, 4.0)


class Shields(unittest.TestCase):
    def test_of_the_flume_and_the_wide_bed(self):
        # Zhang et al. 2022: the flume with H = 12 d and W = 10.5 mm, and tau* = 0.085 of WWF1, whose depth has three
        # digits. They take the tangent for the sine, which is 0.3 % more at 0.0748.
        self.assertAlmostEqual(bed.shields_of(0.0748, 12 * D, D, 2.55, 0.0105), 0.047, delta=3e-5 + 0.003 * 0.047)
        self.assertLess(abs(bed.shields_of(0.016, 0.0412, 5e-3, 2.55) / 0.085 - 1), 0.05 / 41.2)
        for width in (None, 0.0105):
            slope = bed.slope_of(0.05, 0.06, D, 2.55, width)
            self.assertAlmostEqual(bed.shields_of(slope, 0.06, D, 2.55, width), 0.05, 14)


class Literature(unittest.TestCase):
    def test_values_at_two_shields_numbers(self):
        # Worked out by hand from the printed formulas.
        np.testing.assert_allclose(
            literature.meyer_peter_mueller([0.04, 0.085, 0.1408]), (0.0, 0.0593, 0.2298), atol=1e-4
        )
        np.testing.assert_allclose(literature.wong_parker([0.085, 0.1408]), (0.0266, 0.1095), atol=2e-4)
        np.testing.assert_allclose(literature.fernandez_luque_van_beek(0.085, 0.037), 0.0599, atol=1e-4)
        np.testing.assert_allclose(literature.zhang_wide_bed(0.1408), 0.0354, atol=1e-4)
        # 5 sqrt(0.04) = 1, and a load of 0.1 at 0.063 above the threshold: 0.1 (1 + 0.17).
        np.testing.assert_allclose(literature.paehtz_duran([0.03, 0.04, 0.103], 0.04), (0.0, 0.0, 0.117), atol=1e-12)
        np.testing.assert_allclose(literature.old_relations(0.085), (0.0266, 0.0599), atol=2e-4)


if __name__ == "__main__":
    unittest.main()
