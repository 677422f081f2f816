#!/usr/bin/python3
"""The path tracer beside Blender's Cycles: the mean irradiance of one bounce, and variance times processor time of both.

    apt-get install blender python3-openimageio
    scripts/cycles.py                          the Cornell box under a sun
    scripts/cycles.py sponza                   the court of Sponza

Scenes are in $LRSM_SCENES (default ../shared/scenes), files go to out/cycles. Each program renders two seeds on one thread; half their squared difference is
the variance. Blender runs this file too, for the part marked so. Materials become Lambert's there (Principled is Burley's), emission is left out, samples go
through the pixel's centre. Of single-sided materials Cycles lights the backs as well, lrsm does not: in Sponza that shows in the mean.
"""
import json
import os
import resource
import subprocess
import sys

VIEWS = {  # scene, eye, target, vertical degrees, direction and irradiance of the sun, size, samples of Cycles and of lrsm
    "cornell": ("cornell_box.glb", (0, 1, 3.6), (0, 1, 0), 40, (0.3, -0.6, -0.8), 3, (192, 192), 256, 128),
    "sponza": ("sponza.glb", (-8.9, 1.6, -0.35), (4, 2.4, 0.1), 60, (0.25, -1, 0.11), 10, (192, 108), 64, 256),
}


def in_blender(scene, eye, target, degrees, sun, irradiance, size, samples, seed, out):
    import math

    import bpy
    import numpy
    from mathutils import Vector

    numpy.bool = bool  # Blender 3.4's glTF importer asks for it
    z_up = lambda p: Vector((p[0], -p[2], p[1]))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=scene)
    for thing in [o for o in bpy.data.objects if o.type in ("LIGHT", "CAMERA")]:
        bpy.data.objects.remove(thing)
    for material in bpy.data.materials:
        tree = material.node_tree
        principled, output = (next(n for n in tree.nodes if n.type == kind) for kind in ("BSDF_PRINCIPLED", "OUTPUT_MATERIAL"))
        diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = principled.inputs["Base Color"].default_value
        for source, sink in (("Base Color", "Color"), ("Normal", "Normal")):
            for link in principled.inputs[source].links:
                tree.links.new(link.from_socket, diffuse.inputs[sink])
        surface = diffuse.outputs[0]
        for link in principled.inputs["Alpha"].links:
            mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
            for socket, sink in ((link.from_socket, 0), (clear.outputs[0], 1), (surface, 2)):
                tree.links.new(socket, mix.inputs[sink])
            surface = mix.outputs[0]
        tree.links.new(surface, output.inputs["Surface"])

    scene = bpy.context.scene

    def add(name, data, along):
        thing = bpy.data.objects.new(name, data)
        scene.collection.objects.link(thing)
        thing.rotation_mode, thing.rotation_quaternion = "QUATERNION", along.to_track_quat("-Z", "Y")
        return thing

    camera = bpy.data.cameras.new("eye")
    camera.sensor_fit, camera.angle, camera.clip_start = "VERTICAL", math.radians(degrees), 0.001
    scene.camera = add("eye", camera, z_up(target) - z_up(eye))
    scene.camera.location = z_up(eye)
    light = bpy.data.lights.new("sun", "SUN")
    light.angle, light.energy = 0, irradiance
    add("sun", light, z_up(sun))

    scene.render.engine, scene.render.threads_mode, scene.render.threads = "CYCLES", "FIXED", 1
    for key, value in dict(device="CPU", samples=samples, seed=seed, use_adaptive_sampling=False, use_denoising=False, max_bounces=1, diffuse_bounces=1, glossy_bounces=0,
                           transmission_bounces=0, sample_clamp_direct=0, sample_clamp_indirect=0, light_sampling_threshold=0, pixel_filter_type="BOX", filter_width=0.01).items():
        setattr(scene.cycles, key, value)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = *size, 100
    scene.view_layers[0].use_pass_diffuse_indirect = True
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


def seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def luminance(path, layer, scale):
    import numpy
    import OpenImageIO

    picture = OpenImageIO.ImageInput.open(path)
    spec = picture.spec()
    texels = numpy.asarray(picture.read_image("float"), float).reshape(spec.height, spec.width, -1)
    return scale * sum(weight * texels[..., spec.channelnames.index(f"{layer}.{channel}")] for weight, channel in zip((0.2126, 0.7152, 0.0722), "RGB"))


def compare(name):
    import numpy

    file, eye, target, degrees, sun, irradiance, size, samples_cycles, samples_lrsm = VIEWS[name]
    scene = os.path.abspath(os.path.join(os.environ.get("LRSM_SCENES", "../shared/scenes"), file))
    out = os.path.abspath("out/cycles")
    os.makedirs(out, exist_ok=True)
    view = f"{out}/{name}.json"
    with open(view, "w") as f:
        json.dump({"scene": scene, "camera": {"eye": eye, "target": target, "up": [0, 1, 0], "verticalFovDegrees": degrees},
                   "lights": [{"type": "directional", "direction": sun, "color": [1, 1, 1], "intensity": irradiance}]}, f)

    def cycles(samples, seed):
        path = f"{out}/{name}-cycles-{samples}-{seed}.exr"
        spent = seconds(["blender", "-b", "-P", __file__, "--", json.dumps([scene, eye, target, degrees, sun, irradiance, size, samples, seed, path])])
        return luminance(path, "ViewLayer.DiffInd", numpy.pi), spent  # E / pi, the albedo left out

    def lrsm(samples, seed):
        path = f"{out}/{name}-lrsm-{samples}-{seed}"
        spent = seconds(["build/release/apps/lrsm", "reference", view, "--model", "single", "--size", "%dx%d" % size, "--spp", str(samples), "--block", "64",
                         "--seed", str(seed), "--threads", "1", "--quiet", "-o", path])
        return luminance(path + "/image.exr", "irradiance", 1), spent

    rows = {}
    for program, samples in ((cycles, samples_cycles), (lrsm, samples_lrsm)):
        loading = program(1, 1)[1]
        (first, spent_first), (second, spent_second) = program(samples, 1), program(samples, 2)
        mean, variance = (first.mean() + second.mean()) / 2, numpy.mean((first - second) ** 2) / 2
        spent = (spent_first + spent_second) / 2 - loading
        rows[program.__name__] = mean, variance * spent
        print(f"{name}: {program.__name__:6} {samples:4} samples: mean {mean:.6f} +- {numpy.sqrt(variance / 2 / first.size):.6f}, noise {numpy.sqrt(variance) / mean:.4f} of it, {spent:.2f} s and {loading:.2f} s of loading")
    print(f"{name}: lrsm / Cycles: mean {rows['lrsm'][0] / rows['cycles'][0]:.4f}, at equal noise {rows['cycles'][1] / rows['lrsm'][1]:.1f} times as fast")


if "bpy" in sys.modules:
    in_blender(*json.loads(sys.argv[-1]))
else:
    for name in sys.argv[1:] or ["cornell"]:
        compare(name)
