"""Capture: real footage, its calibration and its mattes."""
