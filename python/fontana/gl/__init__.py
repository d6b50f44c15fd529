"""The OpenGL renderer: particles and water among the colliders of a scene, in a window or without one.

    context = create_headless_context()
    renderer = Renderer(context)
    renderer.set_stage(scene.colliders, bounds)
    renderer.set_frame(FrameData(position, velocity, ...))
    picture = renderer.image(camera, (1280, 720), Look(style="fluid"))

Needs the extra `view` (moderngl). Any OpenGL 3.3 core context will do.
"""
