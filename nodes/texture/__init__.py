"""Texture: video-realistic pictures of captured and synthesised motion."""
