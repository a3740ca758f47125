/* offscreen.c: see offscreen.h.
 * SPDX-License-Identifier: MIT */
#include "tests/shaders/offscreen.h"

#include <stdlib.h>
#include <string.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

static EGLDisplay display = EGL_NO_DISPLAY;
static EGLContext context = EGL_NO_CONTEXT;
static GLuint program, inputs[OFFSCREEN_INPUTS], outputs[OFFSCREEN_OUTPUTS];

static const char *make_context(shader_language language)
{
    const int is_es = language == GLSL_ES_300;
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);        /* the same arithmetic on every machine */
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); /* nothing in the user's home */
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get_display = (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress(
        "eglGetPlatformDisplayEXT");
    if (!get_display) return "EGL has no eglGetPlatformDisplayEXT";
    display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return "EGL cannot draw without a window; install Mesa's software renderer, `apt-get install libgl1-mesa-dri`";
    if (!eglBindAPI(is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API)) return "EGL does not have this OpenGL";
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, is_es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLConfig config;
    EGLint n_configs = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &n_configs) || n_configs < 1) return "EGL has no configuration";
    const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    const EGLint desktop[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, is_es ? es : desktop);
    if (context == EGL_NO_CONTEXT) return is_es ? "there is no OpenGL ES 3.0" : "there is no OpenGL 4.5";
    return eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) ? NULL : "the context cannot be used";
}

const char *offscreen_open(shader_language language)
{
    const char *why = make_context(language);
    if (why) {
        offscreen_close();
        return why;
    }
    GLuint vertices, framebuffer;
    glGenVertexArrays(1, &vertices); /* none needed, but a core profile wants one */
    glBindVertexArray(vertices);
    glGenTextures(OFFSCREEN_INPUTS, inputs);
    glGenTextures(OFFSCREEN_OUTPUTS, outputs);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    return NULL;
}

void offscreen_close(void)
{
    program = 0;
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    display = EGL_NO_DISPLAY;
    context = EGL_NO_CONTEXT;
}

const char *offscreen_renderer(void)
{
    return (const char *)glGetString(GL_RENDERER);
}

static int attach(GLenum kind, const char *const *pieces, int n_pieces, char *log, size_t size)
{
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, n_pieces, pieces, NULL);
    glCompileShader(shader);
    GLint is_compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    if (!is_compiled) glGetShaderInfoLog(shader, (GLsizei)size, NULL, log);
    else glAttachShader(program, shader);
    glDeleteShader(shader);
    return is_compiled;
}

/* One triangle over everything; both languages read it. */
static const char vertex_shader[] =
    "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }";

int offscreen_compile(const char *const *pieces, int n_pieces, char *log, size_t size)
{
    const char *const vertex[] = {pieces[0], vertex_shader}; /* the same #version line */
    if (program) glDeleteProgram(program);
    program = glCreateProgram();
    if (!attach(GL_VERTEX_SHADER, vertex, 2, log, size) || !attach(GL_FRAGMENT_SHADER, pieces, n_pieces, log, size))
        return 0;
    glLinkProgram(program);
    GLint is_linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
    if (!is_linked) glGetProgramInfoLog(program, (GLsizei)size, NULL, log);
    else glUseProgram(program);
    return is_linked;
}

static void fill_texture(GLuint texture, const float *texels, int height)
{
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, OFFSCREEN_WIDTH, height, 0, GL_RGBA, GL_FLOAT, texels);
}

void offscreen_inputs(const char *const names[OFFSCREEN_INPUTS], const float *const texels[OFFSCREEN_INPUTS],
                      int height)
{
    GLenum buffers[OFFSCREEN_OUTPUTS];
    for (int k = 0; k < OFFSCREEN_OUTPUTS; k++) {
        buffers[k] = (GLenum)(GL_COLOR_ATTACHMENT0 + k);
        fill_texture(outputs[k], NULL, height);
        glFramebufferTexture2D(GL_FRAMEBUFFER, buffers[k], GL_TEXTURE_2D, outputs[k], 0);
    }
    glDrawBuffers(OFFSCREEN_OUTPUTS, buffers);
    for (int k = 0; k < OFFSCREEN_INPUTS; k++) {
        glActiveTexture((GLenum)(GL_TEXTURE0 + k));
        fill_texture(inputs[k], texels[k], height);
        glUniform1i(glGetUniformLocation(program, names[k]), k);
    }
    glViewport(0, 0, OFFSCREEN_WIDTH, height);
}

int offscreen_draw(const char *name, const uint32_t *words, int n_vectors, int height,
                   float *const values[OFFSCREEN_OUTPUTS])
{
    glUniform4uiv(glGetUniformLocation(program, name), n_vectors, words);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return 0;
    glDrawArrays(GL_TRIANGLES, 0, 3);
    for (int k = 0; k < OFFSCREEN_OUTPUTS; k++) {
        glReadBuffer((GLenum)(GL_COLOR_ATTACHMENT0 + k));
        glReadPixels(0, 0, OFFSCREEN_WIDTH, height, GL_RGBA, GL_FLOAT, values[k]);
    }
    return glGetError() == GL_NO_ERROR;
}
