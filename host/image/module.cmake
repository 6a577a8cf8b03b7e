whit_module(image
  SOURCES image.c compare.c exr.c hdr.c pfm.c png.c
  LINK whit_base PNG::PNG OpenEXR::OpenEXRCore)
