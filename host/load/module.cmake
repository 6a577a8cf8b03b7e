whit_module(load
  SOURCES load.c format.c up.c model.c model_mesh.c obj.c cut.c ply.c mtl.c mtl_material.c importer.c
    importer_assimp.c importer_glb.c unread.c threemf.c part.c gltf.c gltf_json.c gltf_buffer.c
    gltf_accessor.c gltf_texture.c gltf_material.c gltf_geometry.c gltf_draco.c gltf_nodes.c
    gltf_animation.c gltf_skin.c
    scene_file.c scene_cameras.c scene_reader.c scene_materials.c scene_objects.c scene_shapes.c scene_models.c
    scene_range.c scene_transform.c scene_animation.c texture.c texture_ahead.c environment.c picture.c jpeg.c
  LINK whit_base whit_image whit_scene assimp::assimp PkgConfig::JANSSON JPEG::JPEG
    PkgConfig::STB)

# stb_image shifts signed numbers, which is harmless and not ours; addresses stay checked.
if(WHIT_SANITIZE)
  set_source_files_properties(load/picture.c PROPERTIES COMPILE_OPTIONS -fno-sanitize=undefined)
endif()
