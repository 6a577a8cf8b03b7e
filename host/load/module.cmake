whit_module(load
  SOURCES load.c importer.c importer_assimp.c gltf.c mtl.c model.c scene_file.c texture.c environment.c
  LINK whit_base whit_image whit_scene assimp::assimp PkgConfig::JANSSON PkgConfig::STB)
