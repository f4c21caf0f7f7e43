"""Surface: from mattes to a watertight mesh per frame."""
