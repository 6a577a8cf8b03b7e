whit_module(load
  SOURCES load.c importer.c importer_assimp.c gltf.c mtl.c model.c scene_file.c scene_reader.c scene_materials.c scene_objects.c scene_animation.c texture.c environment.c picture.c
  LINK whit_base whit_image whit_scene assimp::assimp PkgConfig::JANSSON PkgConfig::STB)

# stb_image shifts signed numbers, which is harmless and not ours; addresses stay checked.
if(WHIT_SANITIZE)
  set_source_files_properties(load/picture.c PROPERTIES COMPILE_OPTIONS -fno-sanitize=undefined)
endif()
